// A value or an error: the result of every function that can fail. C++20 here has no std::expected.
// Enters: a T or an Error. Leaves: one of them. Assumes the caller asks `ok()` before it takes the value.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace sgm {

/// Why a function gave no result. `kind` decides the exit code: input, reported 1, usage 2, budget 3, cancelled 130.
struct Error {
    enum class Kind {
        Input,
        Usage,
        Budget,
        Cancelled,
        Internal,
        Reported,  ///< input, whose diagnostics were printed already: nothing is left to say
    };
    Kind kind = Kind::Input;
    std::string message;  ///< a sentence in plain words, located where a place is known
    uint32_t extent = 0;  ///< bytes of the text that it is about, from that place on; 0 where that isn't known
};

/// A T or the Error that stands in its place.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(state_); }
    explicit operator bool() const { return ok(); }
    T& value() & {
        assert(ok());
        return std::get<T>(state_);
    }
    const T& value() const& {
        assert(ok());
        return std::get<T>(state_);
    }
    T&& value() && {
        assert(ok());
        return std::get<T>(std::move(state_));
    }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    const Error& error() const {
        assert(!ok());
        return std::get<Error>(state_);
    }

private:
    std::variant<T, Error> state_;
};

/// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace sgm
