/* SPDX-License-Identifier: Apache-2.0 */
/* Firmware written for a VPC3+C becomes a live slave: a DP master opens the printed pty and talks to it.
   usage: live_slave [URI [SECONDS]] */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include <dpchip/dpchip.h>

#include "firmware.h"

static dpchip_chip *chip;
static dpchip_line *line;
static volatile sig_atomic_t stopped;

uint8_t bus_read(uint16_t address) { return dpchip_chip_read(chip, address); }
void bus_write(uint16_t address, uint8_t value) { dpchip_chip_write(chip, address, value); }

static void stop(int signal_number) {
    (void)signal_number;
    stopped = 1;
    dpchip_line_stop(line);
}

int main(int argc, char **argv) {
    const double seconds = argc > 2 ? atof(argv[2]) : 1e9;
    double lived = 0;
    chip = dpchip_chip_create("vpc3+c");
    line = dpchip_line_open(argc > 1 ? argv[1] : "pty", 0);
    if (chip == NULL || line == NULL || dpchip_line_attach(line, chip) != DPCHIP_OK) {
        fprintf(stderr, "live_slave: %s\n", dpchip_last_error());
        return 1;
    }
    signal(SIGINT, stop);
    signal(SIGTERM, stop);
    firmware_init(8, 0x4711);
    printf("slave 8, ident 4711H, on %s\n", dpchip_line_path(line));
    fflush(stdout);
    while (!stopped && lived < seconds) {
        const int64_t passed = dpchip_line_run(line, 10 * 1000 * 1000);
        if (passed < 0) {
            fprintf(stderr, "live_slave: %s\n", dpchip_last_error());
            break;
        }
        lived += (double)passed / 1e9;
        if (dpchip_chip_interrupt(chip)) firmware_isr();
        firmware_main_loop();
    }
    dpchip_chip_destroy(chip);
    dpchip_line_close(line);
    return 0;
}
