/* SPDX-License-Identifier: Apache-2.0 */
/* Every version number of dpchip, in one place. CMake reads the first three. */
#ifndef DPCHIP_VERSION_H
#define DPCHIP_VERSION_H

#define DPCHIP_VERSION_MAJOR 0
#define DPCHIP_VERSION_MINOR 1
#define DPCHIP_VERSION_PATCH 0
#define DPCHIP_VERSION "0.1.0"

#define DPCHIP_ABI_VERSION 1      /* of the C library: changes when an existing C program would break */
#define DPCHIP_SNAPSHOT_VERSION 1 /* of Chip::save: changes when an older snapshot cannot be read */

#endif
