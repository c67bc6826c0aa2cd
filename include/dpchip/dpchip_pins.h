/* SPDX-License-Identifier: Apache-2.0 */
/*
 * dpchip as a part: the package with its 44 pins, a bus interface with the timing of the data sheet, and a bit-level line.
 *
 * A board moves input pins and lets time pass; the package moves its output pins and leaves their edges in a queue. Nothing
 * happens behind the caller's back: no threads, no callbacks. Conventions, errors and dpchip_last_error() as in dpchip.h.
 *
 * Time is absolute, in ticks of 1/60 ns from the creation on; one period of the 48 MHz CLK is 1250 ticks. The clock runs by
 * itself: CLK need not be driven.
 *
 * After creation the package is powered up but has seen no RESET. Its inputs are as an idle board holds them: RESET 0, XCS,
 * XRD, XWR, XTEST0, XTEST1 and RXD 1, all others 0, DB Z. Set the straps (XINT/MOT, MODE, DIVIDER), pulse RESET for at
 * least 100 ns, then begin.
 *
 * Not modelled: volts and currents, test modes behind XTEST1, and what no manual says; see README.md.
 */
#ifndef DPCHIP_DPCHIP_PINS_H
#define DPCHIP_DPCHIP_PINS_H

#include "dpchip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dpchip_pins dpchip_pins;

/* A pin is named by its number on the package. */
enum {
    DPCHIP_PIN_XCS_AB11 = 1, DPCHIP_PIN_XWR_E_CLOCK_AB11 = 2, DPCHIP_PIN_DIVIDER = 3, DPCHIP_PIN_XRD_R_W = 4,
    DPCHIP_PIN_CLK = 5, DPCHIP_PIN_VSS_6 = 6, DPCHIP_PIN_CLKOUT = 7, DPCHIP_PIN_XINT_MOT = 8, DPCHIP_PIN_X_INT = 9,
    DPCHIP_PIN_AB10 = 10, DPCHIP_PIN_DB0 = 11, DPCHIP_PIN_DB1 = 12, DPCHIP_PIN_XDATAEXCH_SYNC = 13,
    DPCHIP_PIN_XREADY_XDTACK = 14, DPCHIP_PIN_DB2 = 15, DPCHIP_PIN_DB3 = 16, DPCHIP_PIN_VSS_17 = 17,
    DPCHIP_PIN_VDD_18 = 18, DPCHIP_PIN_DB4 = 19, DPCHIP_PIN_DB5 = 20, DPCHIP_PIN_DB6 = 21, DPCHIP_PIN_DB7 = 22,
    DPCHIP_PIN_MODE = 23, DPCHIP_PIN_ALE_AS_AB11 = 24, DPCHIP_PIN_AB9 = 25, DPCHIP_PIN_TXD = 26, DPCHIP_PIN_RTS = 27,
    DPCHIP_PIN_VSS_28 = 28, DPCHIP_PIN_AB8 = 29, DPCHIP_PIN_RXD = 30, DPCHIP_PIN_AB7 = 31, DPCHIP_PIN_AB6 = 32,
    DPCHIP_PIN_XCTS = 33, DPCHIP_PIN_XTEST0 = 34, DPCHIP_PIN_XTEST1 = 35, DPCHIP_PIN_RESET = 36, DPCHIP_PIN_AB4 = 37,
    DPCHIP_PIN_VSS_38 = 38, DPCHIP_PIN_VDD_39 = 39, DPCHIP_PIN_AB3 = 40, DPCHIP_PIN_AB2 = 41, DPCHIP_PIN_AB5 = 42,
    DPCHIP_PIN_AB1 = 43, DPCHIP_PIN_AB0 = 44
};

/* Levels; Z: nobody drives the pin. */
enum { DPCHIP_LOW = 0, DPCHIP_HIGH = 1, DPCHIP_Z = 2 };

/* Directions. */
enum { DPCHIP_PIN_SUPPLY = 0, DPCHIP_PIN_INPUT = 1, DPCHIP_PIN_OUTPUT = 2, DPCHIP_PIN_BIDIRECTIONAL = 3 };

/* A part: "vpc3+c", "vpc3+b", "vpc3+", "apc3" or "spc3"; 3000..3600 or 4500..5500 millivolts (apc3: 3.3 V only). The caller
   destroys it. */
DPCHIP_API dpchip_pins *dpchip_pins_create(const char *variant, int millivolts);
/* NULL is allowed. */
DPCHIP_API void dpchip_pins_destroy(dpchip_pins *part);

/* The manual's name of a pin ("XCS/AB11"); NULL for a number that is no pin. */
DPCHIP_API const char *dpchip_pins_name(int pin);
/* DPCHIP_PIN_SUPPLY ..., or a negative code. */
DPCHIP_API int dpchip_pins_direction(int pin);

/* Options of the chip, as in dpchip_chip_set_option(), and of the package:
     "fatal" true|false         a timing violation stops the part: every later call that moves it is DPCHIP_E_VIOLATION
     "txd_pull_up" true|false   the board has the pull-up that TXD needs: it reads 1 where the chip leaves it Z
     "check_timing" true|false  bus timing is checked
     "line" pins|none           none: RXD is ignored and TXD stays Z
     "waves_timescale" 1ps      the unit of times in waveforms that begin later, as in dpchip_line_set_option() */
DPCHIP_API int dpchip_pins_set_option(dpchip_pins *part, const char *name, const char *text);

/* ---- pins and time ---------------------------------------------------------------------------------------------- */

/* The board drives an input or a DB pin, now. DPCHIP_Z lets go of it. */
DPCHIP_API int dpchip_pins_set_pin(dpchip_pins *part, int pin, int level);
/* What a probe would show now: DPCHIP_LOW, DPCHIP_HIGH or DPCHIP_Z, or a negative code. */
DPCHIP_API int dpchip_pins_get_pin(const dpchip_pins *part, int pin);
/* Ticks since creation. */
DPCHIP_API int64_t dpchip_pins_now(const dpchip_pins *part);
/* When the part does something by itself; INT64_MAX: only an input can wake it. */
DPCHIP_API int64_t dpchip_pins_next(const dpchip_pins *part);
/* Lets time pass up to `ticks`, an absolute time not before dpchip_pins_now(). */
DPCHIP_API int dpchip_pins_advance(dpchip_pins *part, int64_t ticks);

/* Takes the oldest edge of an output pin. 1: one was taken; 0: there is none. */
DPCHIP_API int dpchip_pins_next_edge(dpchip_pins *part, int64_t *ticks, int *pin, int *level);
/* Whether edges of an output are queued. All are at first, CLKOUT2/4 excepted. */
DPCHIP_API int dpchip_pins_watch(dpchip_pins *part, int pin, int on);

/* Draws all pins but the supplies as waveforms from now on, into a VCD file with a signal for each (XCS_AB11, X_INT); NULL ends
   it, as dpchip_pins_destroy() does. CLKOUT2/4 is drawn while it is watched, everything else always, and CLK where
   dpchip_pins_clock_edge() drives it. DPCHIP_E_FILE: the file cannot be written; with NULL, not all of it was (the disk is
   full). DPCHIP_E_STATE: one is being drawn already. */
DPCHIP_API int dpchip_pins_waves(dpchip_pins *part, const char *path);

/* CLK: rising edges lie at `ticks` plus multiples of 1250; 0 .. 1249, 0 at first. */
DPCHIP_API int dpchip_pins_set_clock_phase(dpchip_pins *part, int64_t ticks);
/* Drives an edge of CLK now, which lasts `slope` ticks between 0.9 V and 2.1 V: its times are checked against section
   10.7.1, and a rising edge sets the phase. The clock runs on without further edges. */
DPCHIP_API int dpchip_pins_clock_edge(dpchip_pins *part, int level, int64_t slope);

/* ---- what the part did not like --------------------------------------------------------------------------------- */

/* Takes the oldest finding of the package or the chip as a line of text; a timing violation names the parameter, its limit
   and the time found. 1: one was taken; 0: there is none. */
DPCHIP_API int dpchip_pins_finding(dpchip_pins *part, char *text, size_t capacity);
/* How often timing parameter `number` (1..60) was violated since creation; 0: all of them together, unnumbered ones too. */
DPCHIP_API int64_t dpchip_pins_violations(const dpchip_pins *part, int number);
/* 1 after a violation with "fatal". */
DPCHIP_API int dpchip_pins_failed(const dpchip_pins *part);

/* ---- the chip inside -------------------------------------------------------------------------------------------- */

/* What a read would deliver, without side effects and without taking time: for debuggers. A null part reads FFH. */
DPCHIP_API uint8_t dpchip_pins_peek(const dpchip_pins *part, uint16_t address);
/* As dpchip_chip_get_info(). */
DPCHIP_API int dpchip_pins_chip_info(const dpchip_pins *part, dpchip_chip_info *info);
/* A snapshot of the chip inside that dpchip_chip_load() reads: octets needed, octets written or a negative code. */
DPCHIP_API size_t dpchip_pins_snapshot_size(const dpchip_pins *part);
DPCHIP_API int64_t dpchip_pins_save(const dpchip_pins *part, void *bytes, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
