// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/user_prm.hpp>

#include <algorithm>
#include <unordered_map>

#include <dpchip/dp/set_prm.hpp>
#include <dpchip/gsd/text.hpp>

namespace dpchip::gsd {
namespace {

bool is_signed(DataType t) { return t == DataType::signed8 || t == DataType::signed16 || t == DataType::signed32; }

std::string label(const Gsd& gsd) { return gsd.file.empty() ? gsd.model_name : gsd.file; }

std::string place(const PrmField& f) {
    return (f.slot == 0 ? std::string{"device"} : "slot " + std::to_string(f.slot)) + ", octet " +
           std::to_string(f.offset);
}

std::string in_hex(unsigned octet) {
    constexpr const char* digits = "0123456789ABCDEF";
    return {digits[octet >> 4 & 15u], digits[octet & 15u], 'h'};
}

/// The field's octets as one number, most significant first.
std::uint32_t read_word(const PrmField& f, std::span<const std::uint8_t> octets) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < f.octets; ++i) word = word << 8 | octets[f.offset + i];
    return word;
}

void write_word(const PrmField& f, std::uint32_t word, std::span<std::uint8_t> octets) {
    for (std::size_t i = f.octets; i-- > 0; word >>= 8) octets[f.offset + i] = static_cast<std::uint8_t>(word);
}

/// Puts a value into a field's bits.
void put(const PrmField& f, std::int64_t value, std::span<std::uint8_t> octets) {
    const std::uint32_t bits = static_cast<std::uint32_t>(value) << f.shift & f.mask;
    write_word(f, (read_word(f, octets) & ~f.mask) | bits, octets);
}

class Builder {
public:
    Builder(const Gsd& gsd, PrmTelegram telegram) : gsd_{gsd}, telegram_{telegram} {
        for (std::size_t i = 0; i < gsd.parameters.size(); ++i) numbers_.insert_or_assign(gsd.parameters[i].number, i);
    }

    UserPrmData build(const Configuration& configuration) {
        const bool set_prm = telegram_ == PrmTelegram::set_prm;
        const UserPrm& device = set_prm ? gsd_.prm : gsd_.ext_prm;
        if (set_prm && device.empty()) grow(0, gsd_.user_prm_data);  // the form of old files
        add(device, 0);
        for (std::size_t i = 0; i < configuration.modules.size(); ++i) {
            const Module& m = gsd_.modules.at(configuration.modules[i]);
            const UserPrm& prm = set_prm ? m.prm : m.ext_prm;
            const std::size_t base = data_.octets.size();
            add(prm, static_cast<std::uint32_t>(i + 1));
            if (prm.length && data_.octets.size() < base + *prm.length) resize(base + *prm.length);
        }
        check_length(device);
        for (std::size_t i = 0; i < data_.octets.size(); ++i) data_.variable.push_back(0);
        for (const PrmField& f : data_.fields) write_word(f, read_word(f, data_.variable) | f.mask, data_.variable);
        if (set_prm && gsd_.dpv1.slave) free_dpv1_status();
        return std::move(data_);
    }

private:
    void resize(std::size_t n) { data_.octets.resize(n); }

    void grow(std::size_t offset, std::span<const std::uint8_t> octets) {
        if (data_.octets.size() < offset + octets.size()) resize(offset + octets.size());
        std::ranges::copy(octets, data_.octets.begin() + static_cast<std::ptrdiff_t>(offset));
    }

    void add(const UserPrm& prm, std::uint32_t slot) {
        const std::size_t base = data_.octets.size();
        for (const PrmConst& c : prm.constants) grow(base + c.offset, c.octets);
        for (const PrmRef& r : prm.refs) {
            const auto found = numbers_.find(r.number);
            if (found == numbers_.end())
                throw GsdError{label(gsd_) + ": there is no ExtUserPrmData " + std::to_string(r.number)};
            const Parameter& p = gsd_.parameters[found->second];
            const PrmField f = field(p, found->second, slot, base + r.offset);
            if (data_.octets.size() < f.offset + f.octets) resize(f.offset + f.octets);
            put(f, p.default_value, data_.octets);
            data_.fields.push_back(f);
        }
    }

    static PrmField field(const Parameter& p, std::size_t index, std::uint32_t slot, std::size_t offset) {
        PrmField f{index, slot, offset, static_cast<std::uint8_t>(octets(p.type)), 0xFFFFFFFFu, 0, p.default_value};
        if (p.type == DataType::bit || p.type == DataType::bit_area) {
            f.shift = p.first_bit;
            f.mask = ((2u << (p.last_bit - p.first_bit)) - 1u) << p.first_bit;
        } else {
            f.mask >>= 32 - 8 * f.octets;
        }
        return f;
    }

    void check_length(const UserPrm& device) const {
        const std::size_t limit = std::min<std::size_t>(device.length.value_or(dp::kMaxUserPrm), dp::kMaxUserPrm);
        if (data_.octets.size() > limit && !(device.empty() && data_.octets.size() == gsd_.user_prm_data.size()))
            throw GsdError{label(gsd_) + ": the parameters take " + std::to_string(data_.octets.size()) +
                           " octets, but " + std::to_string(limit) + " are the limit"};
    }

    /// The master composes DPV1_Status itself: its defined bits are not the GSD's business (reference 3.4.1).
    void free_dpv1_status() {
        constexpr std::uint8_t defined[]{0xE7, 0xFD, 0x9F};
        for (std::size_t i = 0; i < 3 && i < data_.variable.size(); ++i) data_.variable[i] |= defined[i];
    }

    const Gsd& gsd_;
    PrmTelegram telegram_;
    std::unordered_map<std::int64_t, std::size_t> numbers_;
    UserPrmData data_;
};

/// The fields a setting can mean.
std::vector<std::size_t> matches(const Gsd& gsd, const UserPrmData& data, const PrmSetting& s) {
    const std::string wanted = folded(s.parameter);
    const auto number = to_number(wanted);
    const auto search = [&](const auto& is_meant) {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < data.fields.size(); ++i) {
            const PrmField& f = data.fields[i];
            if ((!s.slot || f.slot == *s.slot) && (!s.offset || f.offset == *s.offset) &&
                is_meant(gsd.parameters[f.parameter]))
                found.push_back(i);
        }
        return found;
    };
    auto found = search([&](const Parameter& p) { return folded(p.name) == wanted; });
    if (found.empty() && number) found = search([&](const Parameter& p) { return p.number == *number; });
    return found;
}

std::string listed(const Gsd& gsd, const UserPrmData& data, std::span<const std::size_t> fields) {
    constexpr std::size_t limit = 200;
    std::string text;
    for (std::size_t i = 0; i < fields.size() && i < limit; ++i) {
        const PrmField& f = data.fields[fields[i]];
        const Parameter& p = gsd.parameters[f.parameter];
        text += "\n  " + place(f) + ": " + p.name + " (" + std::to_string(p.number) + ")";
    }
    if (fields.size() > limit) text += "\n  ... and " + std::to_string(fields.size() - limit) + " more";
    return text;
}

std::size_t find_field(const Gsd& gsd, const UserPrmData& data, const PrmSetting& s) {
    const auto found = matches(gsd, data, s);
    if (found.size() == 1) return found.front();
    const std::string what = label(gsd) + ": parameter '" + s.parameter + "'";
    if (!found.empty()) throw GsdError{what + " could be one of:" + listed(gsd, data, found)};
    std::vector<std::size_t> all(data.fields.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    if (all.empty()) throw GsdError{what + " does not exist: the station has no parameters"};
    throw GsdError{what + " does not exist; there are:" + listed(gsd, data, all)};
}

std::string allowed_values(const Gsd& gsd, const Parameter& p) {
    std::string text;
    for (const ValueRange& r : p.allowed) {
        text += (text.empty() ? "" : ", ") + std::to_string(r.min);
        if (r.max != r.min) text += ".." + std::to_string(r.max);
    }
    const PrmText* names = p.text_ref ? gsd.prm_text(*p.text_ref) : nullptr;
    if (names != nullptr)
        for (const auto& [value, name] : names->texts) text += "\n  " + std::to_string(value) + "  " + name;
    return text;
}

std::int64_t setting_value(const Gsd& gsd, const Parameter& p, const PrmSetting& s) {
    std::optional<std::int64_t> value;
    if (const PrmText* names = p.text_ref ? gsd.prm_text(*p.text_ref) : nullptr)
        for (const auto& [number, name] : names->texts)
            if (!value && folded(name) == folded(s.value)) value = number;
    if (!value) value = to_number(trim(s.value));
    if (!value || !p.allows(*value))
        throw GsdError{label(gsd) + ": '" + s.value + "' is no value of parameter '" + p.name +
                       "'; allowed: " + allowed_values(gsd, p)};
    if (!p.changeable && *value != p.default_value)
        throw GsdError{label(gsd) + ": parameter '" + p.name + "' is not changeable"};
    return *value;
}

}  // namespace

PrmSetting prm_setting(std::string_view text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string_view::npos || trim(text.substr(0, equals)).empty())
        throw GsdError{"parameter '" + std::string{text} + "': [SLOT:]PARAMETER[@OFFSET]=VALUE expected"};
    PrmSetting s;
    s.value = std::string{trim(text.substr(equals + 1))};
    std::string_view name = trim(text.substr(0, equals));
    constexpr std::int64_t limit = 255;
    if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) {
        const auto slot = to_number(trim(name.substr(0, colon)));
        if (slot && *slot >= 0 && *slot <= limit) {
            s.slot = static_cast<std::uint32_t>(*slot);
            name = trim(name.substr(colon + 1));
        }
    }
    if (const std::size_t at = name.rfind('@'); at != std::string_view::npos) {
        const auto offset = to_number(trim(name.substr(at + 1)));
        if (offset && *offset >= 0 && *offset <= limit) {
            s.offset = static_cast<std::size_t>(*offset);
            name = trim(name.substr(0, at));
        }
    }
    s.parameter = std::string{name};
    return s;
}

UserPrmData user_prm_data(const Gsd& gsd, const Configuration& configuration, std::span<const PrmSetting> settings,
                          PrmTelegram telegram) {
    UserPrmData data = Builder{gsd, telegram}.build(configuration);
    for (const PrmSetting& s : settings) {
        const PrmField& f = data.fields[find_field(gsd, data, s)];
        put(f, setting_value(gsd, gsd.parameters[f.parameter], s), data.octets);
    }
    for (PrmField& f : data.fields) f.value = field_value(gsd, f, data.octets);
    return data;
}

std::int64_t field_value(const Gsd& gsd, const PrmField& f, std::span<const std::uint8_t> octets) {
    if (f.offset > octets.size() || f.octets > octets.size() - f.offset) return 0;
    const std::uint32_t bits = (read_word(f, octets) & f.mask) >> f.shift;
    if (f.parameter >= gsd.parameters.size() || !is_signed(gsd.parameters[f.parameter].type)) return bits;
    const std::int64_t sign = std::int64_t{1} << (8 * f.octets - 1);
    return (std::int64_t{bits} ^ sign) - sign;
}

std::optional<PrmFault> check_user_prm(const Gsd& gsd, const UserPrmData& expected,
                                       std::span<const std::uint8_t> received) {
    using Kind = PrmFault::Kind;
    if (received.size() != expected.octets.size())
        return PrmFault{Kind::length,
                        0,
                        {},
                        std::to_string(received.size()) + " octets of user parameters, not " +
                            std::to_string(expected.octets.size())};
    for (std::size_t i = 0; i < received.size(); ++i)
        if (((received[i] ^ expected.octets[i]) & ~expected.variable[i] & 0xFFu) != 0)
            return PrmFault{Kind::constant,
                            i,
                            {},
                            "constant octet " + std::to_string(i) + " is " + in_hex(received[i]) + ", not " +
                                in_hex(expected.octets[i])};
    for (std::size_t i = 0; i < expected.fields.size(); ++i) {
        const PrmField& f = expected.fields[i];
        const Parameter& p = gsd.parameters[f.parameter];
        const std::int64_t value = field_value(gsd, f, received);
        if (value != f.value && !p.allows(value))
            return PrmFault{Kind::range, f.offset, i,
                            place(f) + ": " + std::to_string(value) + " is no value of parameter '" + p.name + "'"};
    }
    return std::nullopt;
}

}  // namespace dpchip::gsd
