// SPDX-License-Identifier: Apache-2.0
// What the modules say through SystemC's reports, by message type, so that a platform can choose what becomes of each:
// sc_report_handler::set_actions(report::kFinding, SC_DO_NOTHING).
#pragma once

#include <string>

#include <systemc>

namespace dpchip::tlm::report {

inline constexpr const char* kChip = "/dpchip/chip";        ///< a chip that cannot be what was asked for (error)
inline constexpr const char* kLine = "/dpchip/line";        ///< a line that cannot do what was asked for (error)
inline constexpr const char* kPackage = "/dpchip/package";  ///< a package that cannot be what was asked for (error)
inline constexpr const char* kTransceiver = "/dpchip/transceiver";  ///< characters on TXD that are none (warning)
inline constexpr const char* kFinding = "/dpchip/finding";  ///< what a chip noticed and firmware or board should not have done (warning)

inline void error(const char* type, const sc_core::sc_object& who, const std::string& words) {
    SC_REPORT_ERROR(type, (std::string{who.name()} + ": " + words).c_str());
}
inline void warning(const char* type, const sc_core::sc_object& who, const std::string& words) {
    SC_REPORT_WARNING(type, (std::string{who.name()} + ": " + words).c_str());
}

}  // namespace dpchip::tlm::report
