/* SPDX-License-Identifier: Apache-2.0 */
/* Testing firmware without hardware: virtual time, and the test plays the master. An argument is a VCD file to draw into. */
#include <stdio.h>
#include <string.h>

#include <dpchip/dpchip.h>

#include "firmware.h"

static dpchip_chip *chip;
static dpchip_line *line;

uint8_t bus_read(uint16_t address) { return dpchip_chip_read(chip, address); }
void bus_write(uint16_t address, uint8_t value) { dpchip_chip_write(chip, address, value); }

/* The firmware lives; dpchip_line_run returns early whenever X/INT goes active. */
static void live(int64_t nanoseconds) {
    int64_t spent = 0;
    while (spent < nanoseconds) {
        spent += dpchip_line_run(line, nanoseconds - spent);
        if (dpchip_chip_interrupt(chip)) firmware_isr();
        firmware_main_loop();
    }
}

/* Sends a telegram and compares the answer; nothing is expected: silence. */
static int tell(const char *request, size_t n, const char *expected, size_t m) {
    unsigned char answer[255];
    const int sent = dpchip_line_send(line, request, n);
    const int got = dpchip_line_receive(line, answer, sizeof answer, 1000000);
    live(1000000);
    return sent == DPCHIP_OK && got == (int)m && memcmp(answer, expected, m) == 0;
}
#define TELL(request, expected) tell(request, sizeof request - 1, expected, sizeof expected - 1)

int main(int argc, char **argv) {
    int good = 1;
    chip = dpchip_chip_create("vpc3+c");
    line = dpchip_line_open("sim:", 1500000);
    dpchip_chip_set_option(chip, "baud_probe_ms", "1");
    dpchip_line_attach(line, chip);
    firmware_init(8, 0x4711);
    if (argc > 1) good &= dpchip_line_waves(line, argv[1], NULL) == DPCHIP_OK;
    live(3500000); /* the search has come to 1.5 Mbit/s; the telegram that proves it is not answered */
    good &= TELL("\x10\x08\x02\x49\x53\x16", "");
    good &= TELL("\x10\x08\x02\x49\x53\x16", "\x10\x02\x08\x00\x0A\x16");
    good &= TELL("\x68\x0C\x0C\x68\x88\x82\x6D\x3D\x3E\x80\x01\x01\x0B\x47\x11\x00\xD7\x16", "\xE5"); /* Set_Prm */
    good &= TELL("\x68\x07\x07\x68\x88\x82\x5D\x3E\x3E\x11\x21\x15\x16", "\xE5");                     /* Chk_Cfg */
    good &= TELL("\x68\x05\x05\x68\x08\x02\x7D\x12\x34\xCD\x16", "\x68\x05\x05\x68\x02\x08\x08\x00\x00\x12\x16");
    good &= TELL("\x68\x05\x05\x68\x08\x02\x5D\x12\x34\xAD\x16", "\x68\x05\x05\x68\x02\x08\x08\x12\x34\x58\x16");
    puts(good ? "the firmware answers as it should" : "something is wrong");
    dpchip_line_close(line);
    dpchip_chip_destroy(chip);
    return good ? 0 : 1;
}
