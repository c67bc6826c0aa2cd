// SPDX-License-Identifier: Apache-2.0
// The keywords of blocks: PrmText, ExtUserPrmData, Module, SlotDefinition, diagnosis texts.
#include <dpchip/gsd/parser.hpp>

#include <limits>
#include <utility>

namespace dpchip::gsd {
namespace {

constexpr std::int64_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t kMaxDiagBit = 243 * 8 - 1;

bool is_x(const Statement& s) { return s.key.starts_with("x_"); }

}  // namespace

// ---- PrmText ------------------------------------------------------------------------------------------------------

void Parser::prm_text(Statement& s) {
    if (in_prm_text_) warn(s.at, "EndPrmText is missing before PrmText");
    in_prm_text_ = true;
    gsd_.prm_texts.push_back({number(s, "PrmText", 0, kMaxIndex).value_or(-1), {}});
    done(s);
}

void Parser::prm_text_line(Statement& s) {
    if (!in_prm_text_) return warn(s.at, "Text outside PrmText is ignored");
    const auto t = text(s);
    if (!t) return;
    if (!s.index) return error(s.at, "Text: value in parentheses expected");
    if (!gsd_.prm_texts.back().texts.insert_or_assign(*s.index, *t).second)
        warn(s.at, "Text(" + std::to_string(*s.index) + ") again: the last one counts");
    done(s);
}

void Parser::end_prm_text(Statement& s) {
    if (!std::exchange(in_prm_text_, false)) warn(s.at, "EndPrmText without PrmText");
    done(s);
}

// ---- ExtUserPrmData -----------------------------------------------------------------------------------------------

void Parser::ext_user_prm_data(Statement& s) {
    if (in_parameter_) warn(s.at, "EndExtUserPrmData is missing before ExtUserPrmData");
    in_parameter_ = true;
    has_type_ = false;
    Parameter p;
    p.at = s.at;
    p.number = number(s, "ExtUserPrmData", 0, kMaxIndex).value_or(-1);
    if (const Token* t = s.value.string()) p.name = std::string{trim(t->text)};
    else warn(s.at, "ExtUserPrmData: text expected");
    gsd_.parameters.push_back(std::move(p));
    done(s);
}

void Parser::data_type(Statement& s) {
    // clang-format off
    static constexpr std::pair<const char*, DataType> types[]{
        {"bit", DataType::bit},           {"bitarea", DataType::bit_area},     {"unsigned8", DataType::unsigned8},
        {"unsigned16", DataType::unsigned16}, {"unsigned32", DataType::unsigned32}, {"signed8", DataType::signed8},
        {"signed16", DataType::signed16}, {"signed32", DataType::signed32}};
    // clang-format on
    if (!in_parameter_) return warn(s.at, s.name + " outside ExtUserPrmData is ignored");
    if (has_type_) return error(s.at, s.name + ": the parameter has a type already");
    has_type_ = true;
    Parameter& p = gsd_.parameters.back();
    for (const auto& [key, type] : types)
        if (s.key == key) p.type = type;
    const bool bits = p.type == DataType::bit || p.type == DataType::bit_area;
    if (bits) {
        const std::int64_t first = s.index.value_or(-1), last = s.index2.value_or(first);
        if (first < 0 || last < first || last > 7) error(s.at, s.name + ": bits 0..7 in parentheses expected");
        else p.first_bit = static_cast<std::uint8_t>(first), p.last_bit = static_cast<std::uint8_t>(last);
    }
    const auto value = number(s, s.name.c_str(), -kMaxIndex, kMaxIndex);
    if (!value) return;
    p.default_value = *value;
    p.allowed = ranges(s);
    done(s);
}

void Parser::prm_text_ref(Statement& s) {
    if (!in_parameter_) return warn(s.at, "Prm_Text_Ref outside ExtUserPrmData is ignored");
    gsd_.parameters.back().text_ref = number(s, "Prm_Text_Ref", 0, kMaxIndex);
    done(s);
}

void Parser::changeable(Statement& s) {
    if (!in_parameter_) return keep(s);
    assign(s, gsd_.parameters.back().changeable);
    done(s);
}

void Parser::visible(Statement& s) {
    if (!in_parameter_) return keep(s);
    assign(s, gsd_.parameters.back().visible);
    done(s);
}

void Parser::end_ext_user_prm_data(Statement& s) {
    if (!in_parameter_) warn(s.at, "EndExtUserPrmData without ExtUserPrmData");
    else if (!has_type_) error(gsd_.parameters.back().at, "parameter without type");
    in_parameter_ = false;
    done(s);
}

UserPrm& Parser::user_prm(const Statement& s) {
    if (in_module_) return is_x(s) ? gsd_.modules.back().ext_prm : gsd_.modules.back().prm;
    return is_x(s) ? gsd_.ext_prm : gsd_.prm;
}

void Parser::prm_const(Statement& s) {
    if (!s.index || *s.index < 0 || *s.index > kMaxPrmOffset)
        return error(s.at, s.name + ": offset 0..243 in parentheses expected");
    user_prm(s).constants.push_back({static_cast<std::uint16_t>(*s.index), octets(s)});
}

void Parser::prm_ref(Statement& s) {
    if (!s.index || *s.index < 0 || *s.index > kMaxPrmOffset)
        return error(s.at, s.name + ": offset 0..243 in parentheses expected");
    if (const auto n = number(s, s.name.c_str(), 0, kMaxIndex))
        user_prm(s).refs.push_back({static_cast<std::uint16_t>(*s.index), *n, s.at});
    done(s);
}

// ---- Module -------------------------------------------------------------------------------------------------------

void Parser::module(Statement& s) {
    if (in_module_) warn(s.at, "EndModule is missing before Module");
    in_module_ = true;
    Module m;
    m.at = s.at;
    if (const Token* t = s.value.string()) m.name = std::string{trim(t->text)};
    else error(s.at, "Module: name in quotes expected");
    s.value.accept(',');
    m.cfg = octets(s);
    gsd_.modules.push_back(std::move(m));
}

void Parser::module_reference(Statement& s) {
    Module& m = gsd_.modules.back();
    if (m.reference) warn(s.at, "second reference number " + quoted(s.name) + " of a module");
    else m.reference = to_number(s.name);
    done(s);
}

void Parser::module_prm_length(Statement& s) {
    if (!in_module_) warn(s.at, s.name + " outside Module is taken for Max_User_Prm_Data_Len");
    if (const auto n = number(s, s.name.c_str(), 0, kMaxPrmOffset + 1))
        user_prm(s).length = static_cast<std::uint16_t>(*n);
    done(s);
}

void Parser::preset(Statement& s) {
    if (!in_module_) return keep(s);
    assign(s, gsd_.modules.back().preset);
    done(s);
}

void Parser::info_text(Statement& s) {
    if (const auto t = text(s)) (in_module_ ? gsd_.modules.back().info_text : gsd_.info_text) = *t;
    done(s);
}

void Parser::end_module(Statement& s) {
    if (!std::exchange(in_module_, false)) warn(s.at, "EndModule without Module");
    done(s);
}

// ---- SlotDefinition -----------------------------------------------------------------------------------------------

void Parser::slot_definition(Statement& s) {
    in_slots_ = true;
    done(s);
}

void Parser::slot(Statement& s) {
    if (!in_slots_) warn(s.at, "Slot outside SlotDefinition");
    SlotRule rule;
    rule.at = s.at;
    if (!s.index || *s.index < 0 || *s.index > 255) return error(s.at, "Slot: number 0..255 in parentheses expected");
    rule.slot = static_cast<std::uint32_t>(*s.index);
    if (const Token* t = s.value.string()) rule.name = std::string{trim(t->text)};
    const auto preferred = number(s, "Slot", 0, kMaxIndex);
    if (!preferred) return;
    rule.default_module = *preferred;
    rule.allowed = ranges(s);
    gsd_.slots.push_back(std::move(rule));
    done(s);
}

void Parser::end_slot_definition(Statement& s) {
    if (!std::exchange(in_slots_, false)) warn(s.at, "EndSlotDefinition without SlotDefinition");
    done(s);
}

// ---- diagnosis texts ----------------------------------------------------------------------------------------------

DiagTexts& Parser::diag() {
    if (in_diag_type_) return gsd_.unit_diag_types.back().texts;
    return in_module_ ? gsd_.modules.back().diag : gsd_.diag;
}

void Parser::unit_diag_bit(Statement& s) {
    const auto t = text(s);
    if (!t) return;
    if (!s.index || *s.index < 0 || *s.index > kMaxDiagBit)
        return error(s.at, s.name + ": bit 0..1943 in parentheses expected");
    const bool inverted = s.key.find("not_bit") != std::string::npos || s.key.find('!') != std::string::npos;
    auto& bits = inverted ? diag().not_bits : diag().bits;
    bits.push_back({static_cast<std::uint32_t>(*s.index), *t, ""});
    done(s);
}

void Parser::unit_diag_bit_help(Statement& s) {
    const auto t = text(s);
    if (!t) return;
    auto& bits = s.key.find("not_bit") != std::string::npos ? diag().not_bits : diag().bits;
    // A help text follows its bit's text.
    if (bits.empty() || !s.index || bits.back().bit != *s.index)
        return warn(s.at, s.name + ": no text of that bit before it");
    bits.back().help = *t;
    done(s);
}

void Parser::unit_diag_area(Statement& s) {
    if (in_area_) warn(s.at, "Unit_Diag_Area_End is missing before " + s.name);
    in_area_ = false;
    const auto first = number(s, s.name.c_str(), 0, kMaxDiagBit);
    if (!first) return;
    auto last = first;
    if (s.value.accept('-')) last = number(s, s.name.c_str(), *first, kMaxDiagBit);
    if (!last) return;
    in_area_ = true;
    diag().areas.push_back({static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*last), {}});
    done(s);
}

void Parser::area_value(Statement& s) {
    if (!in_area_ || diag().areas.empty()) return warn(s.at, s.name + " outside Unit_Diag_Area is ignored");
    const auto t = text(s);
    if (!t) return;
    if (!s.index) return error(s.at, s.name + ": value in parentheses expected");
    if (!diag().areas.back().values.insert_or_assign(*s.index, *t).second)
        warn(s.at, s.name + "(" + std::to_string(*s.index) + ") again: the last one counts");
    done(s);
}

void Parser::unit_diag_area_end(Statement& s) {
    if (!std::exchange(in_area_, false)) warn(s.at, s.name + " without Unit_Diag_Area");
    done(s);
}

void Parser::unit_diag_type(Statement& s) {
    if (in_diag_type_) warn(s.at, "EndUnitDiagType is missing before UnitDiagType");
    in_diag_type_ = false;
    const auto type = number(s, "UnitDiagType", 0, 255);
    if (!type) return;
    in_diag_type_ = true;
    gsd_.unit_diag_types.push_back({*type, {}});
    done(s);
}

void Parser::end_unit_diag_type(Statement& s) {
    if (!std::exchange(in_diag_type_, false)) warn(s.at, "EndUnitDiagType without UnitDiagType");
    done(s);
}

void Parser::channel_diag(Statement& s) {
    const auto t = text(s);
    if (!t) return;
    if (!s.index || *s.index < 0 || *s.index > 31)
        return error(s.at, "Channel_Diag: error type 0..31 in parentheses expected");
    diag().channel.insert_or_assign(*s.index, *t);
    done(s);
}

}  // namespace dpchip::gsd
