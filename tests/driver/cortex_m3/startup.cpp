// SPDX-License-Identifier: Apache-2.0
// Vector table, RAM initialisation, and an exit code for the emulator (semihosting SYS_EXIT_EXTENDED).
#include <cstdint>

extern "C" {
extern std::uint32_t data_load, data_start, data_end, bss_start, bss_end, stack_top;
}
int main();

[[noreturn]] static void stop(int code) {
    const std::uint32_t block[2]{0x20026, static_cast<std::uint32_t>(code)};
    register std::uint32_t operation asm("r0") = 0x20;
    register const std::uint32_t* argument asm("r1") = block;
    asm volatile("bkpt 0xAB" : : "r"(operation), "r"(argument) : "memory");
    for (;;) {}
}

extern "C" [[noreturn]] void reset() {
    const std::uint32_t* from = &data_load;
    for (std::uint32_t* to = &data_start; to < &data_end;) *to++ = *from++;
    for (std::uint32_t* to = &bss_start; to < &bss_end;) *to++ = 0;
    stop(main());
}
extern "C" [[noreturn]] void fault() { stop(99); }

using Handler = void (*)();
extern "C" [[gnu::section(".vectors"), gnu::used]] const Handler vectors[16]{
    reinterpret_cast<Handler>(&stack_top), reset, fault, fault, fault, fault, fault};
