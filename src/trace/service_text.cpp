// SPDX-License-Identifier: Apache-2.0
// Set_Prm, Chk_Cfg, Global_Control and the other services in words.
#include <dpchip/core/bits.hpp>
#include <dpchip/dp/cfg.hpp>
#include <dpchip/dp/global_control.hpp>
#include <dpchip/dp/set_prm.hpp>
#include <dpchip/dp/set_slave_add.hpp>
#include <dpchip/dp/structured_prm.hpp>
#include <dpchip/trace/service_text.hpp>
#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

using Octets = std::span<const std::uint8_t>;

std::string prm_bits(std::uint8_t octet, std::uint8_t value) {
    std::string words;
    for (const dp::PrmBit& bit : dp::kPrmBits)
        if (bit.octet == octet && (value & bit.mask) != 0) add_word(words, bit.name);
    return words;
}

std::string groups_text(std::uint8_t groups) {
    std::string words;
    for (unsigned i = 0; i < 8; ++i)
        if (core::bit(groups, i)) add_word(words, std::to_string(i + 1), " ");
    return words;
}

void blocks_text(Octets data, std::vector<std::string>& details) {
    dp::PrmBlockWalker walker{data};
    for (dp::PrmBlock block{}; walker.next(block);)
        details.push_back(std::string{dp::prm_block_name(block.type)} + " slot " + std::to_string(block.slot) + ": " + hex_row(block.data));
    if (walker.error() != dp::PrmBlockError::none)
        details.push_back(std::string{"damaged block: "} + hex_row(data.subspan(walker.offset())));
}

std::string duration_text(std::uint32_t ms) {
    return ms >= 10'000 && ms % 1000 == 0 ? std::to_string(ms / 1000) + " s" : std::to_string(ms) + " ms";
}

void status_details(const dp::SetPrm& prm, std::vector<std::string>& details) {
    static constexpr const char* kNames[]{"DPV1_Status_1 ", "DPV1_Status_2 ", "DPV1_Status_3 "};
    for (std::uint8_t i = 0; i < 3 && i < prm.user_prm.size(); ++i) {
        const std::string bits = prm_bits(static_cast<std::uint8_t>(7 + i), prm.user_prm[i]);
        details.push_back(kNames[i] + hex_number(prm.user_prm[i]) + (bits.empty() ? "" : ": " + bits));
    }
    if ((prm.dpv1_status_3() & dp::kPrmStructure) != 0) blocks_text(prm.behind_dpv1_status(), details);
    else if (prm.user_prm.size() > 3) details.push_back(std::string{"User_Prm_Data "} + hex_row(prm.behind_dpv1_status(), 244));
}

DataText set_prm_text(Octets data) {
    DataText text;
    const auto prm = dp::decode_set_prm(data);
    if (!prm) {
        text.words = (prm.error() == dp::SetPrmError::too_short ? "fewer than 7 octets: " : "more than 244 octets: ") + hex_row(data);
        return text;
    }
    const std::string station_status = prm_bits(0, prm->station_status);
    text.words = station_status.empty() ? "no Lock, no Unlock" : station_status;
    text.details.push_back(std::string{"Station_Status "} + hex_number(prm->station_status) + ": " + text.words);
    const std::string wd = duration_text(dp::t_wd_ms(prm->wd, prm->wd_base()));
    if (prm->wd_on()) text.words += ", WD " + wd;
    text.details.push_back(std::string{"WD_Fact "} + std::to_string(prm->wd.factor_1) + " * " + std::to_string(prm->wd.factor_2) + ": " + wd +
                           (prm->wd_on() ? "" : ", not in use"));
    if (prm->min_tsdr != 0) text.words += std::string{", minTSDR "} + std::to_string(prm->min_tsdr) + " tBit";
    text.details.push_back(std::string{"minTSDR "} + std::to_string(prm->min_tsdr) + (prm->min_tsdr == 0 ? ": unchanged" : " tBit"));
    text.words += std::string{", ident "} + hex_number(prm->ident, 4);
    text.details.push_back(std::string{"Ident_Number "} + hex_number(prm->ident, 4));
    const std::string groups = groups_text(prm->group_ident);
    if (!groups.empty()) text.words += ", groups " + groups;
    text.details.push_back(std::string{"Group_Ident "} + hex_number(prm->group_ident) + ": " + (groups.empty() ? "no group" : "groups " + groups));
    if (!prm->user_prm.empty()) text.words += std::string{", user "} + hex_row(prm->user_prm);
    status_details(*prm, text.details);
    return text;
}

std::string direction_text(const dp::CfgLength& length, const char* direction) {
    if (length.octets == 0) return {};
    const unsigned count = length.words ? length.octets / 2u : length.octets;
    return std::to_string(count) + (length.words ? " word" : " octet") + (count == 1 ? "" : "s") + ' ' + direction +
           (length.whole ? " consistent" : "");
}

DataText cfg_text(Octets data, dp::CfgUse use) {
    DataText text;
    const dp::CfgTotals totals = dp::cfg_totals(data, use);
    text.words = std::to_string(totals.output_octets) + " out, " + std::to_string(totals.input_octets) + " in: " + hex_row(data);
    dp::CfgWalker walker{data, use};
    for (dp::CfgBlock block{}; walker.next(block);) {
        std::string words = direction_text(block.output, "out");
        add_word(words, direction_text(block.input, "in"));
        if (block.empty_slot()) add_word(words, "empty slot");
        if (block.wildcard) add_word(words, "manufacturer octets not compared");
        if (!block.manufacturer.empty()) add_word(words, std::string{"manufacturer "} + hex_row(block.manufacturer));
        text.details.push_back(std::string{"Cfg "} + hex_row(data.subspan(block.offset, block.size)) + ": " + words);
    }
    if (!totals.ok()) {
        text.words += std::string{" ("} + dp::name(totals.error) + ')';
        text.details.push_back(std::string{"Cfg octet "} + std::to_string(totals.error_offset) + ": " + dp::name(totals.error));
    }
    return text;
}

DataText global_control_text(Octets data) {
    DataText text;
    if (data.size() != dp::kGlobalControlSize) {
        text.words = std::string{"not 2 octets: "} + hex_row(data);
        return text;
    }
    const dp::GlobalControl gc = dp::decode_global_control(data);
    for (const dp::GcBit& bit : dp::kGcBits)
        if ((gc.control_command & bit.mask) != 0) add_word(text.words, bit.name);
    if (gc.reserved_set()) add_word(text.words, std::string{"reserved bits "} + hex_number(gc.control_command & dp::kGcReserved));
    if (text.words.empty()) text.words = "Operate";
    text.details.push_back(std::string{"Control_Command "} + hex_number(gc.control_command) + ": " + text.words);
    const std::string to = gc.group_select == 0 ? std::string{"all"} : std::string{"groups "} + groups_text(gc.group_select);
    text.details.push_back(std::string{"Group_Select "} + hex_number(gc.group_select) + ": " + to);
    text.words += " to " + to;
    return text;
}

DataText set_slave_add_text(Octets data) {
    DataText text;
    const auto ssa = dp::decode_set_slave_add(data);
    if (!ssa) {
        text.words = std::string{"fewer than 4 octets: "} + hex_row(data);
        return text;
    }
    text.words = std::string{"new address "} + std::to_string(ssa->address) + ", ident " + hex_number(ssa->ident, 4) +
                 (ssa->no_add_chg ? ", for good" : "");
    text.details = {"New_Slave_Address " + std::to_string(ssa->address), std::string{"Ident_Number "} + hex_number(ssa->ident, 4),
                    std::string{"No_Add_Chg "} + hex_number(data[3])};
    if (!ssa->rem_data.empty()) {
        text.words += std::string{", data "} + hex_row(ssa->rem_data);
        text.details.push_back(std::string{"Rem_Slave_Data "} + hex_row(ssa->rem_data, 244));
    }
    return text;
}

DataText plain_text(const char* label, Octets data) {
    if (data.empty()) return {};
    return {std::string{label} + ' ' + hex_row(data), {std::string{label} + ' ' + hex_row(data, 244)}};
}

}  // namespace

DataText request_text(dp::Service service, Octets data) {
    switch (service) {
    case dp::Service::set_prm: return set_prm_text(data);
    case dp::Service::chk_cfg: return cfg_text(data, dp::CfgUse::chk_cfg);
    case dp::Service::global_control: return global_control_text(data);
    case dp::Service::set_slave_add: return set_slave_add_text(data);
    case dp::Service::data_exchange: return plain_text("out", data);
    case dp::Service::set_ext_prm: {
        DataText text{"blocks " + hex_row(data), {}};
        blocks_text(data, text.details);
        return text;
    }
    case dp::Service::ms1:
    case dp::Service::ms1_alarm:
    case dp::Service::resource_manager:
    case dp::Service::ms2: return acyclic_text(dp::AcyclicDirection::request, data);
    case dp::Service::rd_input:
    case dp::Service::rd_output:
    case dp::Service::get_cfg:
    case dp::Service::slave_diag:
    case dp::Service::none: break;
    }
    return plain_text("data", data);
}

DataText answer_text(dp::Service service, Octets data, std::uint8_t station, const DeviceTexts* texts) {
    switch (service) {
    case dp::Service::slave_diag: return diag_text(data, station, texts);
    case dp::Service::get_cfg: return cfg_text(data, dp::CfgUse::get_cfg);
    case dp::Service::data_exchange:
    case dp::Service::rd_input: return plain_text("in", data);
    case dp::Service::rd_output: return plain_text("out", data);
    case dp::Service::set_prm:
    case dp::Service::chk_cfg:
    case dp::Service::global_control:
    case dp::Service::set_slave_add:
    case dp::Service::set_ext_prm:
    case dp::Service::none: break;
    case dp::Service::ms1:
    case dp::Service::ms1_alarm:
    case dp::Service::resource_manager:
    case dp::Service::ms2: return acyclic_text(dp::AcyclicDirection::answer, data);
    }
    return plain_text("data", data);
}

}  // namespace dpchip::trace
