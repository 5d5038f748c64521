// How Python calls the library: errors become exceptions, long work runs without Python's lock.
// Enters: results of the library. Leaves: values or Python exceptions. Assumes that Python's lock is held by the
// caller.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "grammar/pipeline/context.h"
#include "grammar/syntax/source.h"
#include "modeler/core/result.h"

namespace sgm::python {

/// Throws the exception of `sgm.errors` that stands for the error's kind.
[[noreturn]] void raise(const Error& error);
/// Throws sgm.GrammarError with all diagnostics.
[[noreturn]] void raise(const syntax::Diagnostics& diagnostics);

/// The value of a result, or its exception.
template <class T>
T valueOf(Result<T> result) {
    if (!result.ok()) raise(result.error());
    return std::move(*result);
}

/// Runs `work` on a thread of its own, without Python's lock. Meanwhile calls `told(stage, fraction)` every 50 ms,
/// unless it is None, and asks for signals; an exception from either, as of Ctrl-C, cancels `progress` and is thrown
/// once the work has ended. The first 50 ms pass without a call.
void runWatched(const pybind11::object& told, Progress& progress, const std::function<void()>& work);

/// The stages of a call: `work(context)` by runWatched.
template <class T, class Work>
T staged(const pybind11::object& told, int threads, pipeline::Stages& stages, Work&& work) {
    Progress progress;
    pipeline::Context context{&progress, threads, {}};
    std::optional<Result<T>> result;
    runWatched(told, progress, [&] { result.emplace(work(context)); });
    stages.insert(stages.end(), context.stages.begin(), context.stages.end());
    return valueOf(std::move(*result));
}

}  // namespace sgm::python
