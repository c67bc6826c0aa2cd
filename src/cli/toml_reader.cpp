// SPDX-License-Identifier: Apache-2.0
// Typed access to a TOML table.
#include <algorithm>

#include <fmt/format.h>

#include <dpchip/cli/toml_reader.hpp>

namespace dpchip::cli {

Place TomlReader::place(std::string_view key) const {
    const toml::node* const node = table_.get(key);
    return place_of(node != nullptr ? *node : table_);
}

void TomlReader::refuse_key(std::string_view key, const std::string& message) const {
    refuse(place(key), fmt::format("{}: {}", key, message));
}

const toml::node* TomlReader::node(std::string_view key) {
    asked_.emplace_back(key);
    return table_.get(key);
}

std::optional<std::string> TomlReader::text(std::string_view key) {
    const toml::node* const found = node(key);
    if (found == nullptr) return std::nullopt;
    if (!found->is_string()) refuse_key(key, "a text in quotes is expected");
    return std::string{*found->value<std::string_view>()};
}

std::optional<std::string> TomlReader::text_or_number(std::string_view key) {
    const toml::node* const found = node(key);
    if (found == nullptr) return std::nullopt;
    if (const auto* number = found->as_integer()) return std::to_string(number->get());
    if (const auto* number = found->as_floating_point()) return fmt::format("{}", number->get());
    return text(key);
}

std::optional<std::int64_t> TomlReader::integer(std::string_view key, std::int64_t min, std::int64_t max) {
    const toml::node* const found = node(key);
    if (found == nullptr) return std::nullopt;
    const auto* number = found->as_integer();
    if (number == nullptr) refuse_key(key, "a whole number is expected");
    if (number->get() < min || number->get() > max) refuse_key(key, fmt::format("{} is not in {} .. {}", number->get(), min, max));
    return number->get();
}

std::optional<bool> TomlReader::boolean(std::string_view key) {
    const toml::node* const found = node(key);
    if (found == nullptr) return std::nullopt;
    const auto* value = found->as_boolean();
    if (value == nullptr) refuse_key(key, "true or false is expected");
    return value->get();
}

std::optional<Ticks> TomlReader::duration(std::string_view key) {
    const auto value = text(key);
    if (!value) return std::nullopt;
    const auto time = parse_duration(*value);
    if (!time) refuse_key(key, fmt::format("\"{}\" is no time; write \"2ms\", \"250us\" or \"1.5s\"", *value));
    return time;
}

std::optional<std::vector<std::uint8_t>> TomlReader::octets(std::string_view key) {
    const auto value = text(key);
    if (!value) return std::nullopt;
    auto octets = parse_hex(*value);
    if (!octets) refuse_key(key, fmt::format("\"{}\" is not a row of hexadecimal octets such as \"01 A0\"", *value));
    return octets;
}

std::vector<std::string> TomlReader::texts(std::string_view key) {
    std::vector<std::string> all;
    const toml::node* const found = node(key);
    if (found == nullptr) return all;
    if (found->is_string()) return {std::string{*found->value<std::string_view>()}};
    const toml::array* const array = found->as_array();
    if (array == nullptr) refuse_key(key, "a list of texts is expected, as in [\"8 DI\", \"8 DO\"]");
    for (const toml::node& element : *array) {
        if (!element.is_string()) refuse(place_of(element), fmt::format("{}: a text in quotes is expected", key));
        all.emplace_back(*element.value<std::string_view>());
    }
    return all;
}

std::vector<std::int64_t> TomlReader::integers(std::string_view key, std::int64_t min, std::int64_t max) {
    const toml::node* const found = node(key);
    if (found == nullptr) return {};
    const toml::array* const array = found->as_array();
    if (array == nullptr) return {*integer(key, min, max)};
    std::vector<std::int64_t> all;
    for (const toml::node& element : *array) {
        const auto* const number = element.as_integer();
        if (number == nullptr) refuse(place_of(element), fmt::format("{}: whole numbers are expected", key));
        if (number->get() < min || number->get() > max) refuse(place_of(element), fmt::format("{}: {} is not in {} .. {}", key, number->get(), min, max));
        all.push_back(number->get());
    }
    return all;
}

const toml::table* TomlReader::table(std::string_view key) {
    const toml::node* const found = node(key);
    if (found == nullptr) return nullptr;
    if (!found->is_table()) refuse_key(key, "a table is expected, as in { NAME = VALUE }");
    return found->as_table();
}

std::vector<const toml::table*> TomlReader::tables(std::string_view key) {
    std::vector<const toml::table*> all;
    const toml::node* const found = node(key);
    if (found == nullptr) return all;
    const toml::array* const array = found->as_array();
    if (array == nullptr) refuse_key(key, fmt::format("write [[{}]] with double brackets: there may be several", key));
    for (const toml::node& element : *array) {
        if (!element.is_table()) refuse(place_of(element), fmt::format("{}: write [[{}]]", key, key));
        all.push_back(element.as_table());
    }
    return all;
}

std::optional<std::size_t> TomlReader::word(std::string_view key, const std::vector<std::string_view>& words) {
    const auto value = text(key);
    if (!value) return std::nullopt;
    const auto found = std::find(words.begin(), words.end(), *value);
    if (found == words.end()) refuse_key(key, fmt::format("\"{}\" is none of {}", *value, fmt::join(words, ", ")));
    return static_cast<std::size_t>(found - words.begin());
}

void TomlReader::finish() const {
    for (const auto& [key, value] : table_) {
        if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
        const Place at{file_, static_cast<std::uint32_t>(key.source().begin.line), static_cast<std::uint32_t>(key.source().begin.column)};
        refuse(at, fmt::format("unknown key \"{}\" in {}; it knows {}", key.str(), what_, fmt::join(asked_, ", ")));
    }
}

}  // namespace dpchip::cli
