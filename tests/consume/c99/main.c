/* SPDX-License-Identifier: Apache-2.0 */
/* Compiles dpchip.h as C99, makes a chip, and looks at one register. */

#include <dpchip/dpchip.h>
#include <stddef.h>

int header_is_cxx17(void);

int main(void) {
    dpchip_chip *chip = dpchip_chip_create("vpc3+c");
    if (chip == NULL) return 1;
    (void)dpchip_chip_peek(chip, 0x04);
    dpchip_chip_destroy(chip);
    if (dpchip_chip_create("no such chip") != NULL) return 2;
    if (dpchip_last_error()[0] == '\0') return 3;
    return header_is_cxx17() ? 0 : 4;
}
