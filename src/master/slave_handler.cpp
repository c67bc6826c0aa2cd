// SPDX-License-Identifier: Apache-2.0
// One slave's way into data exchange.
#include <dpchip/master/slave_handler.hpp>

#include <algorithm>

namespace dpchip::master {

using dp::DiagFlag;
using fdl::Request;
using fdl::Response;

const char* name(SlaveState state) {
    switch (state) {
    case SlaveState::absent: return "absent";
    case SlaveState::diagnosis: return "diagnosis";
    case SlaveState::parameters: return "parameters";
    case SlaveState::configuration: return "configuration";
    case SlaveState::ready_check: return "waiting until ready";
    case SlaveState::data_exchange: return "data exchange";
    }
    return "unknown";
}

const char* name(SlaveFault fault) {
    switch (fault) {
    case SlaveFault::none: return "none";
    case SlaveFault::wrong_ident: return "wrong ident number";
    case SlaveFault::locked: return "owned by another master";
    case SlaveFault::prm_fault: return "parameters refused";
    case SlaveFault::cfg_fault: return "configuration refused";
    case SlaveFault::not_supported: return "function not supported";
    case SlaveFault::invalid_answer: return "invalid answer";
    }
    return "unknown";
}

SlaveHandler::SlaveHandler(const SlaveConfig& config) : config_{config}, set_prm_{set_prm_data(config)} {}

bool SlaveHandler::diagnosis_due() const {
    return state_ == SlaveState::diagnosis || state_ == SlaveState::ready_check ||
           (state_ == SlaveState::data_exchange && diagnosis_wanted_);
}

// ---- requests ----------------------------------------------------------------------------------------------------

std::size_t SlaveHandler::compose(std::span<std::uint8_t> out, std::uint8_t master, Mode mode) const {
    if (state_ == SlaveState::absent)
        return fdl::encode_sd1(out, config_.address, master, fdl::request_fc(Request::fdl_status, false, false));
    const std::uint8_t fc = frame_count(Request::srd_high);
    const auto sap = [&](std::uint8_t dsap, std::span<const std::uint8_t> data) {
        return fdl::encode(out, fdl::SapTelegram{config_.address, master, fc, dsap, dp::kMasterSap, data});
    };
    if (diagnosis_due()) return sap(dp::kSapSlaveDiag, {});
    if (state_ == SlaveState::parameters) return sap(dp::kSapSetPrm, set_prm_);
    if (state_ == SlaveState::configuration) return sap(dp::kSapChkCfg, config_.cfg);
    const std::uint8_t exchange = config_.publisher ? frame_count(Request::msrd) : fc;
    if (mode == Mode::operate) return fdl::encode(out, config_.address, master, exchange, outputs());
    static constexpr std::array<std::uint8_t, 244> kZeroes{};
    const std::size_t size = config_.fail_safe ? 0u : config_.output_octets;
    return fdl::encode(out, config_.address, master, exchange, std::span{kZeroes}.first(size));
}

// ---- answers -----------------------------------------------------------------------------------------------------

void SlaveHandler::answered(const fdl::Telegram& t, std::uint8_t master) {
    if (state_ == SlaveState::absent) return on_status(t);
    count_frame(true);
    if (diagnosis_due()) return on_diagnosis(t, master);
    if (state_ == SlaveState::parameters) return on_acknowledge(t, SlaveState::configuration);
    if (state_ == SlaveState::configuration) return on_acknowledge(t, SlaveState::ready_check);
    on_exchange(t);
}

void SlaveHandler::unanswered() {
    ++counters_.unanswered;
    tried_ = true;
    lose(SlaveState::absent);
}

void SlaveHandler::lose(SlaveState to) {
    if (state_ == SlaveState::data_exchange) ++counters_.lost;
    if (to == SlaveState::absent) count_frame(false);
    state_ = to;
    diagnosis_wanted_ = false;
}

void SlaveHandler::invalid() {
    ++counters_.invalid;
    fault_ = SlaveFault::invalid_answer;
    lose(SlaveState::diagnosis);
}

void SlaveHandler::on_status(const fdl::Telegram& t) {
    tried_ = true;
    if (t.sd != fdl::kSd1) return;
    if (t.fc.station_type() != fdl::StationType::slave) {
        ++counters_.invalid;
        fault_ = SlaveFault::invalid_answer;
        return;
    }
    count_frame(false);
    state_ = SlaveState::diagnosis;
}

void SlaveHandler::on_acknowledge(const fdl::Telegram& t, SlaveState good) {
    if (t.sd == fdl::kSc) {
        state_ = good;
        return;
    }
    if (t.sd != fdl::kSd1) return invalid();
    ++counters_.negative;
    state_ = SlaveState::diagnosis;
}

void SlaveHandler::on_diagnosis(const fdl::Telegram& t, std::uint8_t master) {
    diagnosis_wanted_ = false;
    if (t.sd == fdl::kSd1) {
        ++counters_.negative;
        return;
    }
    if (t.sd == fdl::kSc || !t.saps_present()) return invalid();
    const auto header = dp::decode_diag_header(t.data());
    if (!header) return invalid();
    ++counters_.diagnoses;
    diagnosis_size_ = t.data().size();
    std::ranges::copy(t.data(), diagnosis_.begin());
    judge(*header, master);
}

/// Decides from a diagnosis where the slave goes next.
void SlaveHandler::judge(const dp::DiagHeader& h, std::uint8_t master) {
    const bool waiting = state_ != SlaveState::diagnosis;
    if (h.ident != config_.ident) fault_ = SlaveFault::wrong_ident;
    else if (h.master_add != dp::kNoMaster && h.master_add != master) fault_ = SlaveFault::locked;
    else if (waiting && h.has(DiagFlag::not_supported)) fault_ = SlaveFault::not_supported;
    else if (waiting && h.has(DiagFlag::prm_fault)) fault_ = SlaveFault::prm_fault;
    else if (waiting && h.has(DiagFlag::cfg_fault)) fault_ = SlaveFault::cfg_fault;
    if (h.ident != config_.ident || (h.master_add != dp::kNoMaster && h.master_add != master))
        return lose(SlaveState::diagnosis);
    if (!waiting) {
        state_ = SlaveState::parameters;
        return;
    }
    if (h.has(DiagFlag::prm_req) || h.has(DiagFlag::prm_fault) || h.has(DiagFlag::cfg_fault) ||
        h.has(DiagFlag::not_supported) || h.master_add == dp::kNoMaster)
        return lose(SlaveState::diagnosis);
    if (state_ == SlaveState::data_exchange) {
        // Stat_Diag keeps the answers DH, so data exchange and diagnosis take turns and the watchdog stays fed.
        if (h.has(DiagFlag::station_not_ready)) lose(SlaveState::ready_check);
        return;
    }
    if (!h.ready() || h.has(DiagFlag::stat_diag)) return;
    state_ = SlaveState::data_exchange;
    fault_ = SlaveFault::none;
}

void SlaveHandler::on_exchange(const fdl::Telegram& t) {
    if (t.sd == fdl::kSc) {
        if (config_.input_octets != 0) return invalid();
        ++counters_.exchanges;
        return;
    }
    const Response response = t.fc.response();
    if (response != Response::dl && response != Response::dh) {
        ++counters_.negative;
        if (response == Response::rs || response == Response::ue) lose(SlaveState::diagnosis);
        return;
    }
    // A slave without inputs that has a diagnosis sends an octet nobody needs, or none (reference 3.8).
    const bool no_inputs = config_.input_octets == 0 && response == Response::dh && t.unit.size() <= 1;
    if (t.has_dsap() || t.has_ssap() || (t.unit.size() != config_.input_octets && !no_inputs)) return invalid();
    if (!no_inputs) std::ranges::copy(t.unit, inputs_.begin());
    ++counters_.exchanges;
    if (response == Response::dh) diagnosis_wanted_ = true;
}

}  // namespace dpchip::master
