// SPDX-License-Identifier: Apache-2.0
// TOML to records and identification.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include <dpchip/cli/input.hpp>
#include <dpchip/cli/record_config.hpp>
#include <dpchip/dp/acyclic.hpp>

namespace dpchip::cli {
namespace {

std::vector<std::uint8_t> octets_of(const std::string& text) { return {text.begin(), text.end()}; }

slave::Record read_record(const toml::table& table, const std::string& file, const std::function<std::string(const std::string&)>& beside) {
    TomlReader t{table, file, "[[slave.record]]"};
    slave::Record r;
    const auto index = t.integer("index", 0, 255);
    if (!index) refuse(t.place(), "[[slave.record]] without index");
    r.slot = static_cast<std::uint8_t>(t.integer("slot", 0, 254).value_or(0));
    r.index = static_cast<std::uint8_t>(*index);
    r.access = static_cast<slave::RecordAccess>(t.word("access", {"ro", "rw", "wo"}).value_or(1));
    const auto octets = t.octets("octets");
    const auto text = t.text("text");
    const auto from = t.text("file");
    if ((octets ? 1 : 0) + (text ? 1 : 0) + (from ? 1 : 0) > 1) refuse(t.place(), "[[slave.record]]: octets, text or file, not several of them");
    if (octets) r.octets = *octets;
    else if (text) r.octets = octets_of(*text);
    else if (from) r.octets = octets_of(read_all(beside(*from)));
    r.max = static_cast<std::size_t>(t.integer("max", 1, dp::kMaxRecord).value_or(0));
    if (r.octets.size() > dp::kMaxRecord) refuse(t.place(), fmt::format("a record of {} octets: 240 are possible", r.octets.size()));
    if (r.octets.empty() && r.max == 0) refuse(t.place(), "[[slave.record]] needs octets, text, file or max");
    if (r.max != 0 && r.max < r.octets.size()) t.refuse_key("max", "the record is longer");
    t.finish();
    return r;
}

std::optional<std::uint16_t> word(TomlReader& t, std::string_view key) {
    const auto value = t.integer(key, 0, 65535);
    if (!value) return std::nullopt;
    return static_cast<std::uint16_t>(*value);
}

std::optional<std::string> text(TomlReader& t, std::string_view key, std::size_t most) {
    auto value = t.text(key);
    if (value && value->size() > most) t.refuse_key(key, fmt::format("more than {} letters", most));
    return value;
}

template <std::size_t N>
void put(dp::ImText<N>& field, const std::optional<std::string>& value) {
    if (value) field = dp::im_text<N>(*value);
}

void put(std::uint16_t& field, const std::optional<std::uint16_t>& value) {
    if (value) field = *value;
}

}  // namespace

std::vector<slave::Record> read_records(TomlReader& slave, const std::string& file, const std::function<std::string(const std::string&)>& beside) {
    std::vector<slave::Record> records;
    for (const toml::table* table : slave.tables("record")) {
        records.push_back(read_record(*table, file, beside));
        const slave::Record& last = records.back();
        const auto same = [&](const slave::Record& r) { return r.slot == last.slot && r.index == last.index; };
        if (std::count_if(records.begin(), records.end(), same) > 1)
            refuse(slave.place_of(*table), fmt::format("slot {} index {} has a record already", last.slot, last.index));
    }
    return records;
}

std::optional<IdentificationEntry> read_identification(TomlReader& slave, const std::string& file) {
    const toml::table* const table = slave.table("identification");
    if (table == nullptr) return std::nullopt;
    TomlReader t{*table, file, "[slave.identification]"};
    IdentificationEntry e;
    e.manufacturer_id = word(t, "manufacturer_id");
    e.order_id = text(t, "order_id", 20);
    e.serial_number = text(t, "serial_number", 16);
    e.hardware_revision = word(t, "hardware_revision");
    e.software_revision = t.text("software_revision");
    unsigned v[3]{};
    char letter{};
    if (e.software_revision && (std::sscanf(e.software_revision->c_str(), "%c%u.%u.%u", &letter, &v[0], &v[1], &v[2]) != 4 ||
                                std::any_of(v, v + 3, [](unsigned n) { return n > 255; })))
        t.refuse_key("software_revision", "a letter and three numbers are expected, such as \"V1.0.2\"");
    e.revision_counter = word(t, "revision_counter");
    e.profile_id = word(t, "profile_id");
    e.profile_type = word(t, "profile_type");
    e.tag_function = text(t, "tag_function", 32);
    e.tag_location = text(t, "tag_location", 22);
    e.installation_date = text(t, "installation_date", 16);
    e.descriptor = text(t, "descriptor", 54);
    t.finish();
    return e;
}

slave::Identification identification(const gsd::Gsd& gsd, const IdentificationEntry& e) {
    slave::Identification id = slave::identification(gsd);
    put(id.im0.manufacturer_id, e.manufacturer_id);
    put(id.im0.order_id, e.order_id);
    put(id.im0.serial_number, e.serial_number);
    put(id.im0.hardware_revision, e.hardware_revision);
    put(id.im0.revision_counter, e.revision_counter);
    put(id.im0.profile_id, e.profile_id);
    put(id.im0.profile_specific_type, e.profile_type);
    put(id.im1.tag_function, e.tag_function);
    put(id.im1.tag_location, e.tag_location);
    put(id.im2.installation_date, e.installation_date);
    put(id.im3.descriptor, e.descriptor);
    if (!e.software_revision) return id;
    unsigned v[3]{};
    char letter = 'V';
    std::sscanf(e.software_revision->c_str(), "%c%u.%u.%u", &letter, &v[0], &v[1], &v[2]);
    id.im0.software_revision = {letter, static_cast<char>(v[0]), static_cast<char>(v[1]), static_cast<char>(v[2])};
    return id;
}

}  // namespace dpchip::cli
