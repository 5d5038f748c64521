#include "integrations/python/src/call.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace py = pybind11;

namespace sgm::python {
namespace {

/// Calls sgm.errors.NAME(arguments…), which makes an exception, and throws that.
template <class... Arguments>
[[noreturn]] void raiseMade(const char* name, Arguments&&... arguments) {
    const py::object made = py::module_::import("sgm.errors").attr(name)(std::forward<Arguments>(arguments)...);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
    throw py::error_already_set();
}

const char* nameOf(Error::Kind kind) {
    switch (kind) {
        case Error::Kind::Usage:
            return "usage";
        case Error::Kind::Budget:
            return "budget";
        case Error::Kind::Cancelled:
            return "cancelled";
        case Error::Kind::Internal:
            return "internal";
        default:
            return "input";
    }
}

/// Lets Python act on signals and tells it how far the work is. False with Python's error set where either fails.
bool attend(const py::object& told, const Progress& progress) {
    if (PyErr_CheckSignals() != 0) return false;
    if (told.is_none()) return true;
    try {
        told(std::string(progress.stage()), progress.fraction());
    } catch (py::error_already_set& failure) {
        failure.restore();
        return false;
    }
    return true;
}

}  // namespace

void raise(const Error& error) { raiseMade("_made", nameOf(error.kind), error.message); }

void raise(const syntax::Diagnostics& diagnostics) {
    std::string rendered;
    for (const syntax::Diagnostic& d : diagnostics.all()) rendered += syntax::render(d);
    raiseMade("_made_of_diagnostics", rendered, syntax::toJson(diagnostics));
}

void runWatched(const py::object& told, Progress& progress, const std::function<void()>& work) {
    std::exception_ptr thrown;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
    {
        const py::gil_scoped_release withoutLock;
        std::thread worker([&] {
            try {
                work();
            } catch (...) {
                thrown = std::current_exception();
            }
            const std::lock_guard lock(mutex);
            done = true;
            ended.notify_one();
        });
        const auto hasEnded = [&] {
            std::unique_lock lock(mutex);
            return ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; });
        };
        while (!hasEnded()) {
            const py::gil_scoped_acquire withLock;
            if (type || attend(told, progress)) continue;
            PyErr_Fetch(&type, &value, &trace);
            progress.cancel();
        }
        worker.join();
    }
    if (type) {
        PyErr_Restore(type, value, trace);
        throw py::error_already_set();
    }
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace sgm::python
