// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/describe.hpp>

#include <algorithm>
#include <optional>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/diag.hpp>

namespace dpchip::gsd {
namespace {

constexpr const char* kDigits = "0123456789ABCDEF";

void line(std::string& out, std::string_view label, std::string_view value) {
    if (value.empty()) return;
    out += label;
    out.append(label.size() < 20 ? 20 - label.size() : 1, ' ');
    out += value;
    out += '\n';
}

std::string padded(std::string text, std::size_t width) {
    if (text.size() < width) text.append(width - text.size(), ' ');
    return text;
}

std::string rates(const Gsd& gsd) {
    std::string out;
    for (std::size_t i = 0; i < kRates; ++i) {
        const RateSupport& r = gsd.rates[i];
        if (!r.supported) continue;
        out += (out.empty() ? "" : ", ") + std::string{name(static_cast<Rate>(i))};
        if (r.max_tsdr) out += " (MaxTsdr " + std::to_string(*r.max_tsdr) + ")";
    }
    return out.empty() ? "none" : out;
}

struct Ability {
    bool has;
    const char* name;
};

std::string abilities(std::initializer_list<Ability> all) {
    std::string out;
    for (const Ability& a : all)
        if (a.has) out += (out.empty() ? "" : ", ") + std::string{a.name};
    return out;
}

std::string slave_abilities(const Gsd& g) {
    return abilities({{g.freeze_mode, "Freeze"},
                      {g.sync_mode, "Sync"},
                      {g.auto_baud, "Auto_Baud"},
                      {g.set_slave_add, "Set_Slave_Add"},
                      {g.fail_safe, "Fail_Safe"},
                      {g.fail_safe_required, "Fail_Safe_required"},
                      {g.dpv1.slave, "DP-V1"},
                      {g.dpv1.c1_read_write, "MS1"},
                      {g.dpv1.c2_read_write, "MS2"},
                      {g.dpv1.wd_base_1ms, "WD_Base 1 ms"},
                      {g.dpv1.check_cfg_mode, "Check_Cfg_Mode"},
                      {g.dpv1.ident_maintenance, "I&M"},
                      {g.dpv2.publisher, "Publisher"},
                      {g.dpv2.subscriber, "Subscriber"},
                      {g.dpv2.isochron_mode, "Isochron_Mode"},
                      {g.dpv2.time_sync, "Time_Sync"},
                      {g.dpv2.prm_block_structure, "Prm_Block_Structure"},
                      {g.dpv2.x_prm_sap, "Set_Ext_Prm"}});
}

std::string limit(const std::optional<std::uint32_t>& value) { return value ? std::to_string(*value) : "-"; }

std::string station(const Gsd& g) {
    if (!g.modular_station) return "compact";
    return "modular, at most " + limit(g.max_module) + " modules, " + limit(g.max_input_len) + " octets in, " +
           limit(g.max_output_len) + " out, " + limit(g.max_data_len) + " together";
}

std::string range_text(const Parameter& p) {
    std::string text;
    for (const ValueRange& r : p.allowed)
        text +=
            (text.empty() ? "" : ",") + std::to_string(r.min) + (r.max != r.min ? ".." + std::to_string(r.max) : "");
    return text;
}

/// Value of bits first..last of the data behind a block's header, bit 0 = bit 0 of the first octet; at most 32 bits.
std::optional<std::int64_t> bits_of(std::span<const std::uint8_t> data, std::uint32_t first, std::uint32_t last) {
    if (last < first || last - first >= 32 || last / 8 >= data.size()) return std::nullopt;
    std::int64_t value = 0;
    for (std::uint32_t b = last + 1; b-- > first;) value = value << 1 | (core::bit(data[b / 8], b % 8) ? 1 : 0);
    return value;
}

void add_texts(const DiagTexts& texts, std::span<const std::uint8_t> data, std::vector<std::string>& out) {
    for (const DiagBitText& t : texts.bits)
        if (bits_of(data, t.bit, t.bit) == 1) out.push_back(t.text);
    for (const DiagBitText& t : texts.not_bits)
        if (bits_of(data, t.bit, t.bit) == 0) out.push_back(t.text);
    for (const DiagArea& a : texts.areas)
        if (const auto value = bits_of(data, a.first_bit, a.last_bit))
            if (const auto found = a.values.find(*value); found != a.values.end()) out.push_back(found->second);
}

}  // namespace

std::string hex(std::uint16_t value) {
    std::string out = "0x";
    for (int shift = 12; shift >= 0; shift -= 4) out.push_back(kDigits[value >> shift & 15]);
    return out;
}

std::string hex(std::span<const std::uint8_t> octets) {
    std::string out;
    for (const std::uint8_t o : octets) {
        if (!out.empty()) out.push_back(' ');
        out.push_back(kDigits[o >> 4]);
        out.push_back(kDigits[o & 15]);
    }
    return out;
}

Summary summarize(const Gsd& g) {
    Summary s;
    s.file = g.file;
    s.vendor_name = g.vendor_name;
    s.model_name = g.model_name;
    s.ident_number = g.ident_number;
    s.gsd_revision = g.gsd_revision;
    s.modules = g.modules.size();
    s.parameters = g.parameters.size();
    for (const PrmText& t : g.prm_texts) s.prm_texts += t.texts.size();
    s.diag_texts = g.diag.size();
    for (const UnitDiagType& t : g.unit_diag_types) s.diag_texts += t.texts.size();
    for (const Module& m : g.modules) s.diag_texts += m.diag.size();
    s.keywords = g.keywords.size();
    s.unknown_keywords = static_cast<std::size_t>(
        std::count_if(g.keywords.begin(), g.keywords.end(), [](const Keyword& k) { return !k.known; }));
    return s;
}

std::string describe(const Gsd& g) {
    std::string out;
    line(out, "Vendor_Name", g.vendor_name);
    line(out, "Model_Name", g.model_name);
    line(out, "Ident_Number", hex(g.ident_number));
    line(out, "Revision", g.revision);
    line(out, "Release", g.hardware_release + " / " + g.software_release);
    line(out, "GSD_Revision", std::to_string(g.gsd_revision));
    line(out, "OrderNumber", g.order_number);
    line(out, "Implementation", g.implementation_type);
    line(out, "Slave_Family", g.slave_family);
    line(out, "Info_Text", g.info_text);
    line(out, "Rates", rates(g));
    line(out, "Abilities", slave_abilities(g));
    line(out, "Min_Slave_Intervall", std::to_string(g.min_slave_intervall) + " * 100 us");
    line(out, "Max_Diag_Data_Len", std::to_string(g.max_diag_data_len));
    line(out, "Station", station(g));
    if (g.prm.length) line(out, "User parameters", "at most " + std::to_string(*g.prm.length) + " octets");
    else if (g.user_prm_data_len) line(out, "User parameters", hex(g.user_prm_data));
    const Summary s = summarize(g);
    line(out, "Contents",
         std::to_string(s.modules) + " modules, " + std::to_string(s.parameters) + " parameters, " +
             std::to_string(s.prm_texts) + " value texts, " + std::to_string(s.diag_texts) + " diagnosis texts, " +
             std::to_string(s.unknown_keywords) + " unknown keywords");
    return out;
}

std::string describe_modules(const Gsd& g) {
    std::string out;
    std::size_t width = 0;
    for (const Module& m : g.modules) width = std::max(width, std::min<std::size_t>(m.name.size(), 40));
    for (std::size_t i = 0; i < g.modules.size(); ++i) {
        const Module& m = g.modules[i];
        out += padded("#" + std::to_string(i + 1), 6) + padded(m.name, width) + "  in " +
               padded(std::to_string(m.input_octets), 4) + "out " + padded(std::to_string(m.output_octets), 4) +
               hex(m.cfg) + (m.preset ? "  preset" : "") + "\n";
    }
    return out;
}

std::string describe_parameters(const Gsd& g, const UserPrmData& data) {
    std::string out;
    for (const PrmField& f : data.fields) {
        const Parameter& p = g.parameters[f.parameter];
        std::string bits;
        if (p.type == DataType::bit) bits = "(" + std::to_string(p.first_bit) + ")";
        if (p.type == DataType::bit_area)
            bits = "(" + std::to_string(p.first_bit) + "-" + std::to_string(p.last_bit) + ")";
        const std::string_view text = g.value_text(p, f.value);
        out += padded(f.slot == 0 ? "device" : "slot " + std::to_string(f.slot), 9) +
               padded("@" + std::to_string(f.offset), 6) + padded(name(p.type) + bits, 13) + p.name + " = " +
               std::to_string(f.value) + (text.empty() ? "" : " (" + std::string{text} + ")");
        if (!p.allowed.empty()) out += "  [" + range_text(p) + "]";
        out += '\n';
        const PrmText* texts = p.text_ref ? g.prm_text(*p.text_ref) : nullptr;
        if (texts != nullptr)
            for (const auto& [value, words] : texts->texts)
                out += std::string(28, ' ') + std::to_string(value) + "  " + words + '\n';
    }
    return out;
}

std::string describe_keywords(const Gsd& g, KeywordChoice choice) {
    std::string out;
    for (const Keyword& k : g.keywords) {
        if (k.known && choice == KeywordChoice::unknown_only) continue;
        out += padded(std::to_string(k.at.line), 7) + k.name + (k.value.empty() ? "" : " = " + k.value);
        if (k.module) out += "  (module " + g.modules[*k.module].name + ")";
        out += '\n';
    }
    return out;
}

std::vector<std::string> diag_texts(const Gsd& g, std::span<const std::uint8_t> block) {
    std::vector<std::string> out;
    if (block.size() < 2) return out;
    const auto data = block.subspan(1);
    for (const UnitDiagType& t : g.unit_diag_types)
        if (t.type == data[0]) {
            add_texts(t.texts, data, out);
            return out;
        }
    add_texts(g.diag, data, out);
    return out;
}

std::string channel_error_text(const Gsd& g, std::uint8_t error) {
    const auto found = g.diag.channel.find(error);
    return found != g.diag.channel.end() ? found->second : dp::channel_error_name(error);
}

}  // namespace dpchip::gsd
