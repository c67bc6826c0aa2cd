// SPDX-License-Identifier: Apache-2.0
// `dpchip regs --electrical`: pins, ratings, levels, bus timing and dimensions of a chip, from the tables of regmap and pins.
#pragma once

#include <string>
#include <vector>

#include <dpchip/regmap/variant.hpp>

namespace dpchip::cli {

/// A table for people; every row has as many cells as there are columns.
struct PrintedTable {
    std::string title, place;  ///< place: figure or table of the manual; empty: decided by the model
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// All of them that hold for the chip.
std::vector<PrintedTable> electrical_tables(regmap::Variant variant);

std::string electrical_text(regmap::Variant variant);
std::string electrical_markdown(regmap::Variant variant);
std::string electrical_json(regmap::Variant variant);

}  // namespace dpchip::cli
