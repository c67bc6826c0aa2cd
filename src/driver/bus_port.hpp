// SPDX-License-Identifier: Apache-2.0
// How the driver reaches the chip: a concept, and the implementation for a chip in the processor's address space.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dpchip::driver {

/// Byte access to the chip's addresses 0 to FFFH. A read is a command on some of them: one call, one bus cycle.
/// A handle, cheap to copy; blocks run upwards from `a`.
template <class B>
concept BusPort = requires(B& b, std::uint16_t a, std::uint8_t d, std::span<std::uint8_t> out, std::span<const std::uint8_t> in) {
    { b.read(a) } -> std::same_as<std::uint8_t>;
    { b.write(a, d) } -> std::same_as<void>;
    { b.read_block(a, out) } -> std::same_as<void>;
    { b.write_block(a, in) } -> std::same_as<void>;
};

/// A chip that the processor sees at a fixed address, one octet an address.
class MemoryMappedBus {
public:
    // NOLINTNEXTLINE(performance-no-int-to-ptr): an address is what the hardware gives
    explicit MemoryMappedBus(std::uintptr_t base) : base_{reinterpret_cast<volatile std::uint8_t*>(base)} {}

    std::uint8_t read(std::uint16_t address) const { return base_[address]; }
    void write(std::uint16_t address, std::uint8_t value) { base_[address] = value; }
    void read_block(std::uint16_t address, std::span<std::uint8_t> out) const {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = base_[address + i];
    }
    void write_block(std::uint16_t address, std::span<const std::uint8_t> in) {
        for (std::size_t i = 0; i < in.size(); ++i) base_[address + i] = in[i];
    }

private:
    volatile std::uint8_t* base_;
};
static_assert(BusPort<MemoryMappedBus>);

}  // namespace dpchip::driver
