// SPDX-License-Identifier: Apache-2.0
// Files of the state folder.
#include <fcntl.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include <dpchip/cli/input.hpp>
#include <dpchip/cli/state_store.hpp>
#include <dpchip/cli/toml_reader.hpp>
#include <dpchip/live/descriptor.hpp>

namespace dpchip::cli {

StateStore::StateStore(std::string folder) : folder_{std::move(folder)} {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error || !std::filesystem::is_directory(folder_)) throw Failure{ExitCode::failed, folder_ + ": cannot be made: " + error.message()};
}

std::string StateStore::path(const SlaveEntry& entry) const {
    std::string name = entry.name.empty() ? fmt::format("slave-{}", entry.address.value_or(126)) : entry.name;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '_';
    return folder_ + '/' + name + ".toml";
}

std::optional<slave::StoredAddress> StateStore::load(const SlaveEntry& entry, std::uint16_t ident) const {
    const std::string file = path(entry);
    if (!std::filesystem::exists(file)) return std::nullopt;
    const std::string text = read_all(file);
    toml::table table;
    try {
        table = toml::parse(std::string_view{text}, std::string_view{file});
    } catch (const toml::parse_error& e) {
        refuse({file, static_cast<std::uint32_t>(e.source().begin.line), static_cast<std::uint32_t>(e.source().begin.column)}, std::string{e.description()});
    }
    TomlReader t{table, file, "the state of a slave"};
    const auto address = t.integer("address", 0, 126);
    const auto locked = t.boolean("no_add_change");
    const auto of = t.integer("ident", 0, 0xFFFF);
    t.finish();
    if (!address || !locked || !of) refuse({file, 0, 0}, "address, no_add_change or ident is missing");
    if (*of != ident) refuse(t.place("ident"), fmt::format("ident 0x{:04X} is another device's; {} has 0x{:04X}", *of, title(entry), ident));
    return slave::StoredAddress{static_cast<std::uint8_t>(*address), *locked};
}

void StateStore::save(const SlaveEntry& entry, std::uint16_t ident, const slave::StoredAddress& stored) const {
    const std::string file = path(entry), fresh = file + ".new";
    const std::string text = fmt::format("# What Set_Slave_Add gave to {}.\naddress = {}\nno_add_change = {}\nident = 0x{:04X}\n", title(entry),
                                         stored.address, stored.no_add_change, ident);
    const live::Descriptor fd{::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    const bool written = fd && ::write(fd.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(fd.get()) == 0;
    if (!written || std::rename(fresh.c_str(), file.c_str()) != 0)
        throw Failure{ExitCode::failed, file + ": cannot be written: " + std::strerror(errno)};
}

}  // namespace dpchip::cli
