/* SPDX-License-Identifier: Apache-2.0 */
/* Compiles dpchip.h and dpchip_pins.h as C99, makes a chip and a part, and looks at one register and one pin. */

#include <dpchip/dpchip.h>
#include <dpchip/dpchip_pins.h>
#include <stddef.h>

int header_is_cxx17(void);

int main(void) {
    dpchip_chip *chip = dpchip_chip_create("vpc3+c");
    if (chip == NULL) return 1;
    (void)dpchip_chip_peek(chip, 0x04);
    dpchip_chip_destroy(chip);
    if (dpchip_chip_create("no such chip") != NULL) return 2;
    if (dpchip_last_error()[0] == '\0') return 3;
    dpchip_pins *part = dpchip_pins_create("apc3", 3300);
    if (dpchip_pins_get_pin(part, DPCHIP_PIN_XREADY_XDTACK) != DPCHIP_HIGH) return 5;
    dpchip_pins_destroy(part);
    return header_is_cxx17() ? 0 : 4;
}
