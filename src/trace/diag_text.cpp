// SPDX-License-Identifier: Apache-2.0
// Slave_Diag in words (reference 3.7, 5.5).
#include <dpchip/dp/alarm.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/trace/service_text.hpp>
#include <dpchip/trace/text.hpp>

namespace dpchip::trace {
namespace {

std::string master_text(std::uint8_t master) {
    return master == dp::kNoMaster ? std::string{"no master"} : std::string{"master "} + std::to_string(master);
}

/// Alarm or status message of a DP-V1 slave. Nobody knows of a station without GSD what its block means: then only what
/// is plausible is said, as a guess.
std::string v1_text(const dp::DiagBlock& block, std::uint8_t station, const DeviceTexts* texts) {
    const auto alarm = dp::alarm_status(block);
    const std::optional<bool> v1 = texts != nullptr ? texts->dpv1_slave(station) : std::nullopt;
    if (!alarm || v1 == false) return {};
    if (v1) return alarm_text(*alarm);
    const bool known = std::string_view{alarm->status ? dp::status_type_name(alarm->type) : dp::alarm_type_name(alarm->type)} != "reserved";
    const bool reserved = alarm->status && (block.octets[3] & 0xFCu) != 0;
    return known && !reserved && alarm->slot <= dp::kMaxAlarmSlot ? "with DP-V1 " + alarm_text(*alarm) : std::string{};
}

std::string device_text(const dp::DiagBlock& block, std::uint8_t station, const DeviceTexts* texts) {
    std::string words = v1_text(block, station, texts);
    if (texts != nullptr)
        for (const std::string& text : texts->device_diag(station, block.data())) add_word(words, text);
    return words;
}

std::string identifier_text(const dp::DiagBlock& block) {
    std::string words;
    for (std::size_t n = 0; n < 8 * block.data().size(); ++n)
        if (dp::identifier_marked(block, n)) add_word(words, std::to_string(n), " ");
    return words.empty() ? std::string{"no module"} : "modules " + words;
}

std::string channel_text(const dp::DiagBlock& block, std::uint8_t station, const DeviceTexts* texts) {
    const dp::ChannelDiag c = dp::channel_diag(block);
    std::string error = texts != nullptr && c.error >= 16 ? texts->channel_error(station, c.error) : std::string{};
    if (error.empty()) error = std::string{dp::channel_error_name(c.error)} + (c.error >= 16 ? std::string{" "} + std::to_string(c.error) : "");
    const char* direction = c.input && c.output ? "input/output" : c.output ? "output" : c.input ? "input" : "reserved";
    return "module " + std::to_string(c.identifier) + " channel " + std::to_string(c.channel) + ' ' + direction + ' ' +
           dp::channel_type_name(c.type) + ": " + error;
}

std::string block_text(const dp::DiagBlock& block, std::uint8_t station, const DeviceTexts* texts) {
    std::string octets = hex_row(block.octets);
    switch (block.kind) {
    case dp::DiagBlockKind::device: {
        const std::string words = device_text(block, station, texts);
        return words.empty() ? octets : octets + ": " + words;
    }
    case dp::DiagBlockKind::identifier: return octets + ": " + identifier_text(block);
    case dp::DiagBlockKind::channel: return octets + ": " + channel_text(block, station, texts);
    case dp::DiagBlockKind::revision: return octets + ": revision " + std::to_string(block.number());
    }
    return octets;
}

void blocks_text(std::span<const std::uint8_t> ext, std::uint8_t station, const DeviceTexts* texts, DataText& text) {
    dp::DiagBlockWalker walker{ext};
    for (dp::DiagBlock block{}; walker.next(block);) {
        const std::string words = block_text(block, station, texts);
        text.details.push_back(std::string{dp::name(block.kind)} + ' ' + words);
        if (block.kind == dp::DiagBlockKind::channel) add_word(text.words, channel_text(block, station, texts));
        else if (block.kind == dp::DiagBlockKind::device) add_word(text.words, device_text(block, station, texts));
    }
    if (walker.error() != dp::DiagError::none)
        text.details.push_back(std::string{"damaged block ("} + dp::name(walker.error()) + ") " + hex_row(ext.subspan(walker.offset())));
}

}  // namespace

DataText diag_text(std::span<const std::uint8_t> data, std::uint8_t station, const DeviceTexts* texts) {
    DataText text;
    const auto header = dp::decode_diag_header(data);
    if (!header) {
        text.words = std::string{dp::name(header.error())} + ": " + hex_row(data);
        return text;
    }
    for (const dp::DiagBit& bit : dp::kDiagBits)
        if (header->has(bit.flag)) add_word(text.words, bit.name);
    text.details.push_back(std::string{"Diag "} + hex_row(data.first(3)) + ": " + (text.words.empty() ? "no flag" : text.words));
    text.details.push_back(std::string{"Diag_Master_Add "} + hex_number(header->master_add) + ": " + master_text(header->master_add));
    text.details.push_back(std::string{"Ident_Number "} + hex_number(header->ident, 4));
    add_word(text.words, master_text(header->master_add));
    text.words += std::string{", ident "} + hex_number(header->ident, 4);
    const auto ext = data.subspan(dp::kDiagHeader);
    if (!ext.empty()) text.words += std::string{", Ext_Diag_Data "} + hex_row(ext);
    blocks_text(ext, station, texts, text);
    return text;
}

}  // namespace dpchip::trace
