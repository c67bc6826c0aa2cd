/* SPDX-License-Identifier: Apache-2.0 */
/*
 * dpchip: PROFIBUS DP slave controllers as a software model. The C API.
 *
 * A chip is created, attached to a line and reached by single processor accesses, as firmware on silicon would reach it.
 * A line is virtual ("sim:") or live (a pty, a serial port, a TCP port). Nothing happens behind the caller's back: there
 * are no threads and no callbacks; chips and lines move only inside the calls below.
 *
 * Threads: one at a time per line and all that is attached to it. Different lines are independent.
 * Errors: functions returning int give 0, or a negative DPCHIP_E_ code; functions returning a pointer give NULL. The words
 * are in dpchip_last_error(), per thread. A null handle is DPCHIP_E_ARGUMENT, never a crash.
 * Time: nanoseconds, or ticks of 1/60 ns, in which every bit time and the 48 MHz clock are whole numbers.
 *
 * Not modelled: what README.md lists.
 */
#ifndef DPCHIP_DPCHIP_H
#define DPCHIP_DPCHIP_H

#include <stddef.h>
#include <stdint.h>

#include "version.h"

#if defined(DPCHIP_BUILDING_CAPI) && defined(__GNUC__)
#define DPCHIP_API __attribute__((visibility("default")))
#else
#define DPCHIP_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dpchip_chip dpchip_chip;
typedef struct dpchip_line dpchip_line;

/* Error codes. */
enum {
    DPCHIP_OK = 0,
    DPCHIP_E_ARGUMENT = -1,  /* a null handle or pointer, a value out of range */
    DPCHIP_E_NAME = -2,      /* no such option, chip or choice */
    DPCHIP_E_STATE = -3,     /* not possible now: already attached, nothing attached, address taken */
    DPCHIP_E_LINE = -4,      /* the port cannot be opened, or is gone */
    DPCHIP_E_MEMORY = -5,    /* out of memory */
    DPCHIP_E_SPACE = -6,     /* the caller's buffer is too small */
    DPCHIP_E_SNAPSHOT = -7,  /* not a snapshot of this chip */
    DPCHIP_E_FILE = -8,      /* a file cannot be written */
    DPCHIP_E_INTERNAL = -9,  /* a defect of the library */
    DPCHIP_E_VIOLATION = -10 /* dpchip_pins.h: bus timing was violated and that is fatal */
};

/* Data format of the processor, pin XINT/MOT. */
enum { DPCHIP_INTEL = 0, DPCHIP_MOTOROLA = 1 };

/* DP_State, WD_State as in the Status Register; DPCHIP_NO_BAUD while searching; DPCHIP_NO_MASTER without an owner. */
enum { DPCHIP_WAIT_PRM_STATE = 0, DPCHIP_WAIT_CFG_STATE = 1, DPCHIP_DATA_EXCH_STATE = 2 };
enum { DPCHIP_BAUD_SEARCH_STATE = 0, DPCHIP_BAUD_CONTROL_STATE = 1, DPCHIP_DP_CONTROL_STATE = 2 };
enum { DPCHIP_NO_BAUD = 15, DPCHIP_NO_MASTER = 255 };

/* Words for the last error of this thread; "" when there was none. Valid until the next failing call of the thread. */
DPCHIP_API const char *dpchip_last_error(void);
/* "0.1.0": of the library, which may be newer than the header. */
DPCHIP_API const char *dpchip_version(void);

/* ---- chips ------------------------------------------------------------------------------------------------------ */

/* A chip after a hardware reset: "vpc3+c", "vpc3+b", "vpc3+", "apc3" or "spc3". The caller destroys it. */
DPCHIP_API dpchip_chip *dpchip_chip_create(const char *variant);
/* Detaches the chip from its line first. NULL is allowed. */
DPCHIP_API void dpchip_chip_destroy(dpchip_chip *chip);
/* A pulse on RESET. Options and the attachment stay. */
DPCHIP_API int dpchip_chip_reset(dpchip_chip *chip);

/* One processor access, side effects included: reading 09H, 0BH, 0DH..11H, 13H and 14H acts. It takes the bus cycle time
   (125 ns unless set otherwise), which moves the chip's line first, so firmware may wait in loops. Any address is legal;
   a null chip reads FFH. */
DPCHIP_API uint8_t dpchip_chip_read(dpchip_chip *chip, uint16_t address);
DPCHIP_API void dpchip_chip_write(dpchip_chip *chip, uint16_t address, uint8_t value);
/* What a read would deliver, without side effects and without taking time. */
DPCHIP_API uint8_t dpchip_chip_peek(const dpchip_chip *chip, uint16_t address);
/* 1 while X/INT is active, whatever its polarity. */
DPCHIP_API int dpchip_chip_interrupt(const dpchip_chip *chip);

/* Output pins that follow from what the chip does; the whole package is in dpchip_pins.h. */
enum { DPCHIP_OUT_X_INT = 0, DPCHIP_OUT_RTS = 1, DPCHIP_OUT_XDATAEXCH_SYNC = 2 };
/* The level of an output now: 0, 1, or a negative code. */
DPCHIP_API int dpchip_chip_level(const dpchip_chip *chip, int output);
/* An output changed. */
typedef struct dpchip_edge {
    int64_t ticks;   /* when, in the time of dpchip_chip_now_ticks */
    int32_t output;  /* DPCHIP_OUT_... */
    int32_t level;   /* from then on */
} dpchip_edge;
/* 1: edges of the outputs are kept from now on; 0: no longer. After dpchip_chip_load ask for the levels. */
DPCHIP_API int dpchip_chip_watch(dpchip_chip *chip, int on);
/* Takes the oldest edge. 1: one was taken; 0: there is none. 1024 are kept; when more come, the oldest are lost. */
DPCHIP_API int dpchip_chip_edge(dpchip_chip *chip, dpchip_edge *edge);

/* The chip's present in ticks of 1/60 ns: its line's time, or its own when it is on no line. */
DPCHIP_API int64_t dpchip_chip_now_ticks(const dpchip_chip *chip);
/* When the chip does something by itself next, in that time; INT64_MAX: nothing is planned. */
DPCHIP_API int64_t dpchip_chip_next_ticks(const dpchip_chip *chip);
/* Lets time pass for a chip that is on no line. */
DPCHIP_API int dpchip_chip_run_ticks(dpchip_chip *chip, int64_t ticks);

/* Options by name, before or after attaching: "dpchip serve --show-options" lists them.
   Example: "baud_probe_ms", "1" shortens the baud rate search. */
DPCHIP_API int dpchip_chip_set_option(dpchip_chip *chip, const char *name, const char *text);
DPCHIP_API int dpchip_chip_set_bus_mode(dpchip_chip *chip, int mode);
/* What waveforms call the chip: up to 100 letters, digits and underscores; "": what dpchip_line_waves makes up. */
DPCHIP_API int dpchip_chip_set_name(dpchip_chip *chip, const char *name);
/* How long one access takes; 0 .. 1000000 ns. */
DPCHIP_API int dpchip_chip_set_access_time(dpchip_chip *chip, int64_t nanoseconds);
/* Pin XCTS: 0 lets the chip send, 1 holds it back. */
DPCHIP_API int dpchip_chip_set_xcts(dpchip_chip *chip, int level);

/* What a test wants to know at a glance. Set `size` to sizeof(dpchip_chip_info) before the call; a library that knows more
   fills only what fits. */
typedef struct dpchip_chip_info {
    size_t size;
    int online;            /* 1 in Passive_Idle, 0 in Offline */
    int dp_state;          /* DPCHIP_..._STATE */
    int wd_state;
    int baud_code;         /* as in the Status Register; DPCHIP_NO_BAUD */
    int address;           /* station address; 255 in Offline */
    int owner;             /* the parameterising master; DPCHIP_NO_MASTER */
    uint32_t findings;     /* findings that wait for dpchip_chip_finding() */
} dpchip_chip_info;
DPCHIP_API int dpchip_chip_get_info(const dpchip_chip *chip, dpchip_chip_info *info);

/* Takes the oldest finding (something the chip noticed and firmware should not have done) as a line of text.
   1: one was taken; 0: there is none. */
DPCHIP_API int dpchip_chip_finding(dpchip_chip *chip, char *text, size_t capacity);

/* Snapshots: everything the chip knows, RAM included. Not its options, its line or its attachment. */
DPCHIP_API size_t dpchip_chip_snapshot_size(const dpchip_chip *chip);
/* The octets written, or a negative code. */
DPCHIP_API int64_t dpchip_chip_save(const dpchip_chip *chip, void *bytes, size_t capacity);
/* On error the chip is unchanged. Only for a chip that is on no line, or on a sim: line. */
DPCHIP_API int dpchip_chip_load(dpchip_chip *chip, const void *bytes, size_t size);

/* ---- lines ------------------------------------------------------------------------------------------------------ */

/* "sim:" virtual time; "pty" or "pty:/tmp/dp0" a new pty; "serial:/dev/ttyUSB0"; "tcp:127.0.0.1:9000".
   baud in bit/s; 0: 19200 (on sim: 1500000). 45450 means 45.45 kbit/s. */
DPCHIP_API dpchip_line *dpchip_line_open(const char *uri, uint32_t baud);
/* Detaches every chip first. NULL is allowed. */
DPCHIP_API void dpchip_line_close(dpchip_line *line);
/* What a master opens: the path of a pty, a device, HOST:PORT; "" on sim:. Valid as long as the line. */
DPCHIP_API const char *dpchip_line_path(const dpchip_line *line);
/* A chip is on one line at a time. Several chips may share a line. */
DPCHIP_API int dpchip_line_attach(dpchip_line *line, dpchip_chip *chip);
DPCHIP_API int dpchip_line_detach(dpchip_line *line, dpchip_chip *chip);

/* Lets time pass: virtual time on sim:, wall time on a live line. Returns the time spent, or a negative code. Returns early,
   at once if need be, when the X/INT of an attached chip has gone active since the last dpchip_line_run returned, also
   during accesses, send and receive. An X/INT that merely stays active does not end it. */
DPCHIP_API int64_t dpchip_line_run(dpchip_line *line, int64_t nanoseconds);
DPCHIP_API int64_t dpchip_line_run_ticks(dpchip_line *line, int64_t ticks);
/* Line time in ticks of 1/60 ns. */
DPCHIP_API int64_t dpchip_line_now_ticks(const dpchip_line *line);
/* When something happens next; INT64_MAX: nothing is planned. */
DPCHIP_API int64_t dpchip_line_next_ticks(dpchip_line *line);
/* Ends a dpchip_line_run on a live line, the present one or the next. The only call that a signal handler may make. */
DPCHIP_API void dpchip_line_stop(dpchip_line *line);

/* The test plays the master; sim: only. Sends octets (a good telegram or not; 1..255) at the earliest moment the bus rules
   allow and returns when the last stop bit has passed. */
DPCHIP_API int dpchip_line_send(dpchip_line *line, const void *bytes, size_t n);
/* Runs the line until a station's telegram has ended: its length, copied as far as it fits. 0: the time is over. */
DPCHIP_API int dpchip_line_receive(dpchip_line *line, void *bytes, size_t capacity, int64_t timeout_ns);

/* The same without waiting, for a caller with a clock of its own: the octets begin at line time `at_ticks` exactly, whatever
   the rules say (a time that has passed means now), or at the earliest moment that the rules allow when it is negative.
   DPCHIP_E_STATE while octets posted before have not begun. */
DPCHIP_API int dpchip_line_post(dpchip_line *line, const void *bytes, size_t n, int64_t at_ticks);

/* What was on the line. Set `size` to sizeof(dpchip_telegram) before the call. */
typedef struct dpchip_telegram {
    size_t size;
    int64_t start_ticks;   /* first start bit, in line time */
    int64_t end_ticks;     /* end of the last stop bit */
    int32_t own;           /* 1: from dpchip_line_send or dpchip_line_post, or from the port of a live line */
    int32_t damaged;       /* 1: not what its sender meant, or not a telegram */
    uint16_t length;
    uint8_t octets[255];   /* as they arrived */
} dpchip_telegram;
/* 1: telegrams of all stations are kept from now on, as they end; 3: also as they begin, for dpchip_line_begun; 0: no longer. */
DPCHIP_API int dpchip_line_watch(dpchip_line *line, int on);
/* Takes the oldest telegram that has ended. 1: one was taken; 0: there is none. 1024 are kept; when more come, the oldest
   are lost. */
DPCHIP_API int dpchip_line_telegram(dpchip_line *line, dpchip_telegram *telegram);

/* Takes the oldest telegram that has begun, as its sender means it: `end_ticks` is in the future, and what becomes of it on
   its way dpchip_line_telegram tells. Telegrams of stations that have joined are left out. Otherwise as above. */
DPCHIP_API int dpchip_line_begun(dpchip_line *line, dpchip_telegram *telegram);

/* A station whose bits are on a wire of the caller's, as those of a package with pins are; sim: only. `baud`: the rate at which
   it sends. Returns its number or a negative code. The line tells it nothing: see dpchip_line_begun. */
DPCHIP_API int dpchip_line_join(dpchip_line *line, uint32_t baud);
/* Now it begins to send, what will be known at the end: planned answers are given up, masters wait, and whatever is on the
   line until dpchip_line_joined_sent, which must follow, is a collision. DPCHIP_E_STATE: it is sending already. */
DPCHIP_API int dpchip_line_joined_begins(dpchip_line *line, int station);
/* What it has sent, from `start_ticks` on, has ended by now; the others hear it at once. `faults`: NULL, or for each octet a
   sum of DPCHIP_FAULT_*. What is not exactly one good telegram is damaged. */
DPCHIP_API int dpchip_line_joined_sent(dpchip_line *line, int station, const void *bytes, const uint8_t *faults, size_t n,
                                       int64_t start_ticks);

/* Records all telegrams from now on into a pcapng file that Wireshark opens; NULL ends the recording. */
DPCHIP_API int dpchip_line_record(dpchip_line *line, const char *path);

/* Draws waveforms from now on into a VCD file, which GTKWave, Surfer and PulseView open; NULL ends it, as closing the line
   does. sim: lines only; on others DPCHIP_E_STATE. Signals, as SCOPE.NAME: line.level, the test's master.TXD, and for each
   chip that is on the line when this is called TXD, RXD, RTS, X_INT, XDATAEXCH_SYNC, Diag_Flag, WD_State, DP_State,
   Baud_Rate, Diag_Master_Add, the buffer state machines (Dout_Buffer_SM) and the interrupt requests (IRR.New_Prm_Data).
   Of a chip that comes later, or a station that has joined, only the bits in line.level and RXD are drawn; a chip that leaves is
   unknown until it is back. A telegram that has begun already is left out.
   The scope of a chip is its name; without one, station_8 when it has address 8, chip_2 when it has none yet and is the
   second on the line. `signals`: patterns with * and ?, with commas in between ("line.*,*.X_INT"); NULL: all.
   DPCHIP_E_NAME: a pattern fits nothing, the words list all signals, and no file is written. DPCHIP_E_FILE: the file cannot
   be written; with NULL, not all of it was (the disk is full). DPCHIP_E_STATE: one is being drawn already. */
DPCHIP_API int dpchip_line_waves(dpchip_line *line, const char *path, const char *signals);
/* Options of the line by name: "waves_timescale" is the unit of times in waveforms that begin later: 1, 10 or 100 and fs, ps,
   ns, us, ms or s; "1ps" at first. Every time is rounded by itself. */
DPCHIP_API int dpchip_line_set_option(dpchip_line *line, const char *name, const char *text);

/* ---- a line of your own ----------------------------------------------------------------------------------------- */

/* A chip that is on no line may be on one that the caller models, a telegram at a time. All of this happens at the chip's
   present: move it with dpchip_chip_run_ticks, not past dpchip_chip_next_ticks, and call dpchip_chip_take there. On a line
   of this library all of it is DPCHIP_E_STATE. */

/* What is wrong with a character; sums of these. */
enum { DPCHIP_FAULT_PARITY = 1, DPCHIP_FAULT_STOP = 2, DPCHIP_FAULT_COLLISION = 4 };

/* Somebody else begins to send: an answer that is planned is given up. */
DPCHIP_API int dpchip_chip_carrier(dpchip_chip *chip);
/* Exactly one good telegram at `baud` bit/s has ended. */
DPCHIP_API int dpchip_chip_hear(dpchip_chip *chip, const void *telegram, size_t n, uint32_t baud);
/* One character has ended. What is no good telegram comes this way, each of its characters. */
DPCHIP_API int dpchip_chip_hear_character(dpchip_chip *chip, uint8_t octet, int faults, uint32_t baud);
/* 1: the chip begins to send, and what is in `telegram`; 0: it does not. */
DPCHIP_API int dpchip_chip_take(dpchip_chip *chip, dpchip_telegram *telegram);

#ifdef __cplusplus
}
#endif

#endif
