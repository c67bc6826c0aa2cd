// SPDX-License-Identifier: Apache-2.0
// A TOML table read key by key: every value checked, every key that nobody asked for refused, each with its place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include <dpchip/cli/failure.hpp>
#include <dpchip/cli/units.hpp>

namespace dpchip::cli {

class TomlReader {
public:
    /// `what` names the table in messages: "[[slave]]". Both references must outlive the reader.
    TomlReader(const toml::table& table, const std::string& file, std::string what)
        : table_{table}, file_{file}, what_{std::move(what)} {}

    Place place() const { return place_of(table_); }
    Place place_of(const toml::node& node) const {
        return {file_, static_cast<std::uint32_t>(node.source().begin.line), static_cast<std::uint32_t>(node.source().begin.column)};
    }
    /// Where `key` stands, or the table.
    Place place(std::string_view key) const;

    const toml::node* node(std::string_view key);
    std::optional<std::string> text(std::string_view key);
    /// A text, or an integer as its text.
    std::optional<std::string> text_or_number(std::string_view key);
    std::optional<std::int64_t> integer(std::string_view key, std::int64_t min, std::int64_t max);
    std::optional<bool> boolean(std::string_view key);
    std::optional<Ticks> duration(std::string_view key);
    std::optional<std::vector<std::uint8_t>> octets(std::string_view key);
    std::vector<std::string> texts(std::string_view key);
    /// A whole number or a list of them.
    std::vector<std::int64_t> integers(std::string_view key, std::int64_t min, std::int64_t max);
    const toml::table* table(std::string_view key);
    /// The tables of `[[key]]`.
    std::vector<const toml::table*> tables(std::string_view key);
    /// One of `words`: its index.
    std::optional<std::size_t> word(std::string_view key, const std::vector<std::string_view>& words);

    [[noreturn]] void refuse_key(std::string_view key, const std::string& message) const;
    /// Refuses keys that nobody asked for.
    void finish() const;

private:
    const toml::table& table_;
    const std::string& file_;
    std::string what_;
    std::vector<std::string> asked_;
};

}  // namespace dpchip::cli
