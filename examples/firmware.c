/* SPDX-License-Identifier: Apache-2.0 */
#include "firmware.h"

enum { OUT = 2, IN = 2, CFG = 2, DIAG = 6, PRM = 16 };
enum { GO_LEAVE = 0x0002, NEW_CFG = 0x0400, NEW_PRM = 0x0800, DX_OUT = 0x2000 };
static const uint8_t cfg[CFG] = {0x11, 0x21}; /* 2 octets in, 2 octets out */
static volatile int outputs_arrived;

static uint16_t buffer(uint8_t segment) { return (uint16_t)(segment << 3); }

void firmware_init(uint8_t station_address, uint16_t ident_number) {
    static const struct { uint8_t address, value; } cells[] = {
        {0x1A, OUT}, {0x1B, 0x10}, {0x1C, 0x11}, {0x1D, 0x12}, /* Dout: length, three buffers */
        {0x1E, IN},  {0x1F, 0x13}, {0x20, 0x14}, {0x21, 0x15}, /* Din */
        {0x24, DIAG}, {0x25, DIAG}, {0x26, 0x16}, {0x27, 0x17}, /* diagnosis */
        {0x28, PRM}, {0x2B, 0x18}, {0x30, 0x1A}, {0x32, 0x1C},  /* Aux 1, Prm, Cfg */
        {0x33, CFG}, {0x34, 0x1E}, {0x17, 0x08},                /* Read_Cfg, empty SAP list */
    };
    uint16_t a;
    unsigned i;
    for (a = 0x16; a < 0x800; ++a) bus_write(a, 0);
    bus_write(0x40, 0xFF); /* end of the SAP list */
    for (i = 0; i < sizeof cells / sizeof cells[0]; ++i) bus_write(cells[i].address, cells[i].value);
    for (i = 0; i < CFG; ++i) bus_write((uint16_t)(buffer(0x1E) + i), cfg[i]);
    bus_write(0x16, station_address);
    bus_write(0x39, 0xFF); /* the address does not change */
    bus_write(0x3A, (uint8_t)ident_number);
    bus_write(0x3B, (uint8_t)(ident_number >> 8));
    bus_write(0x07, 0x01); /* DP_Mode */
    bus_write(0x06, 0xC0); /* Sync, Freeze */
    bus_write(0x04, (uint8_t)~GO_LEAVE);
    bus_write(0x05, (uint8_t)~((NEW_CFG | NEW_PRM | DX_OUT) >> 8));
    bus_write(0x08, 0x01); /* Start_VPC3 */
}

static void check_configuration(void) {
    uint8_t answer;
    do { /* again when another Chk_Cfg came meanwhile */
        const uint16_t at = buffer(bus_read(0x32));
        const int good = bus_read(0x31) == CFG && bus_read(at) == cfg[0] && bus_read((uint16_t)(at + 1)) == cfg[1];
        answer = bus_read(good ? 0x10 : 0x11);
    } while (answer == 1);
}

void firmware_isr(void) {
    const uint16_t events = (uint16_t)(bus_read(0x02) | bus_read(0x03) << 8);
    if (events & NEW_PRM) while (bus_read(0x0E) == 1) {}
    if (events & NEW_CFG) check_configuration();
    if (events & DX_OUT) outputs_arrived = 1;
    bus_write(0x02, (uint8_t)events);
    bus_write(0x03, (uint8_t)(events >> 8));
    bus_write(0x08, 0x02); /* EOI */
}

void firmware_main_loop(void) {
    static const uint8_t dout[4] = {0, 0x10, 0x11, 0x12}, din[4] = {0, 0x13, 0x14, 0x15};
    uint16_t from, to;
    if (!outputs_arrived) return;
    outputs_arrived = 0;
    from = buffer(dout[bus_read(0x0B) & 3]);
    to = buffer(din[bus_read(0x08) >> 4 & 3]);
    bus_write(to, bus_read(from));
    bus_write((uint16_t)(to + 1), bus_read((uint16_t)(from + 1)));
    (void)bus_read(0x09); /* New_Din_Buffer_Cmd */
}
