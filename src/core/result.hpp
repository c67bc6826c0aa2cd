// SPDX-License-Identifier: Apache-2.0
// Result<T, E>: a value, or the enumerator that says why there is none. For code without exceptions.
#pragma once

#include <dpchip/core/assert.hpp>

namespace dpchip::core {

/// Holds either a T or an E. Both must be cheap, default-constructible values; E is an enum.
template <class T, class E>
class [[nodiscard]] Result {
public:
    constexpr Result(const T& value) : value_{value}, ok_{true} {}
    constexpr Result(E error) : error_{error}, ok_{false} {}

    constexpr explicit operator bool() const { return ok_; }
    constexpr const T& operator*() const { DPCHIP_ASSERT(ok_); return value_; }
    constexpr const T* operator->() const { DPCHIP_ASSERT(ok_); return &value_; }
    constexpr E error() const { DPCHIP_ASSERT(!ok_); return error_; }

private:
    T value_{};
    E error_{};
    bool ok_;
};

}  // namespace dpchip::core
