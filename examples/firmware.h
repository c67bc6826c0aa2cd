/* SPDX-License-Identifier: Apache-2.0 */
/* A small firmware for a VPC3+C, as it would run on a microcontroller: two octets out, two octets in, which repeat them. */
#ifndef FIRMWARE_H
#define FIRMWARE_H

#include <stdint.h>

/* The bus of the target: on silicon a pointer into the chip's address window, here the model. */
extern uint8_t bus_read(uint16_t address);
extern void bus_write(uint16_t address, uint8_t value);

void firmware_init(uint8_t station_address, uint16_t ident_number);
void firmware_isr(void);
void firmware_main_loop(void);

#endif
