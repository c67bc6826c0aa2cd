// SPDX-License-Identifier: Apache-2.0
// GSD and modules to a slave's configuration.
#include <dpchip/master/from_gsd.hpp>

namespace dpchip::master {

SlaveConfig slave_config(const gsd::Gsd& gsd, const gsd::Configuration& configuration, std::uint8_t address,
                         std::span<const gsd::PrmSetting> settings) {
    SlaveConfig slave;
    slave.name = gsd.model_name;
    slave.address = address;
    slave.ident = gsd.ident_number;
    slave.user_prm = gsd::user_prm_data(gsd, configuration, settings).octets;
    slave.cfg = configuration.cfg;
    slave.input_octets = configuration.input_octets;
    slave.output_octets = configuration.output_octets;
    slave.min_slave_interval = core::microseconds(100) * gsd.min_slave_intervall;
    slave.fail_safe = gsd.fail_safe && !slave.user_prm.empty() && (slave.user_prm[0] & dp::kFailSafe) != 0;
    return slave;
}

}  // namespace dpchip::master
