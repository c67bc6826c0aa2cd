// SPDX-License-Identifier: Apache-2.0
// Modules in slots: what a station of a GSD is made of, its configuration octets and lengths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/gsd/gsd.hpp>

namespace dpchip::gsd {

/// Modules plugged into a station. A plain value; the Gsd it was made from is needed beside it.
struct Configuration {
    std::vector<std::size_t> modules;  ///< indices into Gsd::modules; element 0 is slot 1
    std::vector<std::uint8_t> cfg;     ///< what Chk_Cfg carries
    std::uint16_t input_octets{};      ///< slave to master (Din)
    std::uint16_t output_octets{};     ///< master to slave (Dout)
};

/// The module that `name` means: its name (case and runs of blanks do not matter), "#n" the n-th module of the file,
/// its reference number, or a beginning that only one module has. Throws GsdError, with the candidates.
std::size_t find_module(const Gsd& gsd, std::string_view name);

/// Plugs these modules in this order and checks the station's limits and slot rules. With FixPresetModules the preset
/// modules come first, named or not. Without names: the preset modules, or the only module there is; otherwise
/// GsdError lists the modules. Throws GsdError for whatever does not fit.
Configuration configure(const Gsd& gsd, std::span<const std::string> names = {});

/// The same with module indices; only limits and slot rules are checked. Throws GsdError.
Configuration configure_modules(const Gsd& gsd, std::vector<std::size_t> modules);

}  // namespace dpchip::gsd
