// Work on a thread that nobody catches for.
// Enters: a function that gives a Result. Leaves: its Result, or an Error in place of an exception. Assumes that what
// the work leaves half done is its own.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>

#include "modeler/core/result.h"

namespace sgm {

/// Calls `work` and gives what it gives; Error::Budget where memory ran out, Error::Internal for other exceptions.
template <class Work>
auto guarded(Work&& work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, "out of memory: try a lower resolution or a smaller model"};
    } catch (const std::length_error&) {  // a size that no memory holds
        return Error{Error::Kind::Budget, "out of memory: try a lower resolution or a smaller model"};
    } catch (const std::exception& e) {
        return Error{Error::Kind::Internal, std::string("internal error: ") + e.what()};
    }
}

}  // namespace sgm
