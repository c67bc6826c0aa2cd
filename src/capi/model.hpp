// SPDX-License-Identifier: Apache-2.0
// What the API says about the chip's model, whether it stands alone or in a package: names, options, findings, snapshots.
#pragma once

#include <optional>
#include <string>

#include <dpchip/chip/chip.hpp>
#include <dpchip/dpchip.h>

namespace dpchip::capi {

using Model = chip::Chip<core::RingTrace>;

/// Nothing, and the error is set, when no chip is called so.
std::optional<regmap::Variant> variant_called(const char* name);
/// Sets an option of the chip by its text; a code.
int set_chip_option(Model& model, const char* name, const char* text);
/// Fills what fits into info->size.
int fill_info(const Model& model, dpchip_chip_info* info);
/// Octets written, or a code.
std::int64_t save_model(const Model& model, void* bytes, std::size_t capacity);

/// "123 ns: misuse: " and the like.
std::string finding_head(const core::Finding& f);
/// A finding of the chip as one line.
std::string chip_finding(const core::Finding& f);
/// Copies as much as fits, with its end.
void give_text(const std::string& words, char* text, std::size_t capacity);

}  // namespace dpchip::capi
