#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds the driver for a Cortex-M3, looks for what must not be in it, prints its size and runs it once in qemu.
# Usage: check.sh SOURCE_DIR BINARY_DIR. Exit code 77: a tool is missing, nothing was checked.
set -eu
source=$1 binary=$2
here=$source/tests/driver/cortex_m3
out=$binary/cortex_m3
for tool in arm-none-eabi-g++ arm-none-eabi-nm arm-none-eabi-size qemu-system-arm; do
    command -v $tool >/dev/null || { echo "left out: $tool is not installed"; exit 77; }
done
mkdir -p "$out"
arm-none-eabi-g++ -mcpu=cortex-m3 -mthumb -Os -std=c++20 -fno-exceptions -fno-rtti -fno-threadsafe-statics \
    -ffunction-sections -fdata-sections -Wall -Wextra -Werror -Wno-psabi \
    -I"$source/include" -I"$binary/include" \
    -nostartfiles --specs=nano.specs -Wl,--gc-sections -Wl,--no-warn-rwx-segments -T "$here/link.ld" \
    "$here/main.cpp" "$here/startup.cpp" -o "$out/driver.elf"

bad=$(arm-none-eabi-nm -C "$out/driver.elf" | grep -E \
    ' (_?malloc|_?free|_?calloc|_?realloc|_sbrk)(_r)?$|operator (new|delete)|__cxa_|_Unwind|__gxx_personality|__aeabi_(unwind|[fd](add|sub|rsub|mul|div|cmp|neg|2)|u?[il]2[fd])' || true)
if [ -n "$bad" ]; then
    echo "the driver must not need these:"
    echo "$bad"
    exit 1
fi
arm-none-eabi-size "$out/driver.elf" | awk 'NR == 2 { printf "drivers with and without DP-V1, the parts of DP-V2 and their main on a Cortex-M3: %d octets of code and constants, %d of data\n", $1, $2 + $3 }'
timeout 60 qemu-system-arm -M lm3s6965evb -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -kernel "$out/driver.elf" </dev/null 2>"$out/qemu.log" || {
    code=$?
    cat "$out/qemu.log"
    echo "step $code of main.cpp failed in qemu"
    exit 1
}
echo "ran in qemu"
