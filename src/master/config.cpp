// SPDX-License-Identifier: Apache-2.0
// Set_Prm from a slave's configuration, and the words of configuration.
#include <dpchip/master/config.hpp>

namespace dpchip::master {

const char* name(Mode mode) {
    switch (mode) {
    case Mode::offline: return "offline";
    case Mode::stop: return "stop";
    case Mode::clear: return "clear";
    case Mode::operate: return "operate";
    }
    return "unknown";
}

const char* name(ConfigError error) {
    switch (error) {
    case ConfigError::address: return "the address is not 0..125";
    case ConfigError::address_taken: return "the address is used twice";
    case ConfigError::too_long: return "too many octets for one telegram";
    case ConfigError::no_cfg: return "there is no configuration octet";
    case ConfigError::watchdog: return "the watchdog time is too long, or missing where links need one";
    case ConfigError::block: return "a block of parameters that cannot be, or parameters without Prm_Structure before it";
    }
    return "unknown";
}

std::vector<std::uint8_t> set_prm_data(const SlaveConfig& slave) {
    dp::SetPrm prm{};
    prm.ident = slave.ident;
    prm.group_ident = slave.group;
    prm.min_tsdr = slave.min_tsdr;
    prm.user_prm = slave.user_prm;
    unsigned status = dp::kLockReq;
    if (slave.sync) status |= dp::kSyncReq;
    if (slave.freeze) status |= dp::kFreezeReq;
    if (slave.watchdog_ms != 0) {
        const auto factors = dp::wd_factors(slave.watchdog_ms, prm.wd_base());
        prm.wd = factors ? *factors : dp::WdFactors{255, 255};
        status |= dp::kWdOn;
    }
    prm.station_status = static_cast<std::uint8_t>(status);
    std::vector<std::uint8_t> out(dp::kMaxSetPrm);
    const auto size = dp::encode(prm, out);
    out.resize(size ? *size : 0);
    return out;
}

}  // namespace dpchip::master
