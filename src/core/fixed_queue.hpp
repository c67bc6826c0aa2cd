// SPDX-License-Identifier: Apache-2.0
// A first-in first-out queue whose capacity is in its type. What does not fit is counted, never lost in silence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <dpchip/core/assert.hpp>

namespace dpchip::core {

template <class T, std::size_t Capacity>
class FixedQueue {
public:
    /// Appends `value`; when the queue is full it is dropped and counted in overflows().
    constexpr void push(const T& value) {
        if (size_ == Capacity) { ++overflows_; return; }
        items_[(head_ + size_) % Capacity] = value;
        ++size_;
    }
    constexpr T pop() {
        DPCHIP_ASSERT(size_ != 0);
        const T value = items_[head_];
        head_ = static_cast<std::uint32_t>((head_ + 1) % Capacity);
        --size_;
        return value;
    }
    /// The oldest value. The queue must not be empty.
    constexpr const T& front() const { DPCHIP_ASSERT(size_ != 0); return items_[head_]; }
    [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
    [[nodiscard]] constexpr std::size_t size() const { return size_; }
    [[nodiscard]] constexpr std::uint64_t overflows() const { return overflows_; }
    static constexpr std::size_t capacity() { return Capacity; }

private:
    std::array<T, Capacity> items_{};
    std::uint32_t head_{};
    std::uint32_t size_{};
    std::uint64_t overflows_{};
};

}  // namespace dpchip::core
