// SPDX-License-Identifier: Apache-2.0
// From sightings to packets; what is wrong with a packet stands in its comment.
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/live/recorder.hpp>

namespace dpchip::live {
namespace {

const char* fault_name(std::uint8_t faults) {
    if ((faults & fdl::fault_collision) != 0) return "collision";
    if ((faults & fdl::fault_parity) != 0) return "parity error";
    return "stop bit missing";
}

/// Empty for a good telegram.
std::string comment_of(const fdl::Transmission& t) {
    if (t.damaged)
        for (std::size_t i = 0; i < t.length; ++i)
            if (t.faults[i] != fdl::fault_none) return std::string{fault_name(t.faults[i])} + " in octet " + std::to_string(i);
    const auto telegram = fdl::decode(t.bytes());
    if (!telegram) return fdl::name(telegram.error());
    return telegram->size == t.length ? std::string{} : std::string{"octets behind the telegram"};
}

}  // namespace

Recorder::Recorder(trace::PcapngWriter& writer, const Options& options)
    : writer_{writer}, options_{options}, interface_{writer.add_interface(options.link_type, options.name)} {}

trace::Direction Recorder::direction(segment::StationIndex sender) const {
    if (options_.port == segment::kNobody) return trace::Direction::unknown;
    return sender == options_.port ? trace::Direction::inbound : trace::Direction::outbound;
}

void Recorder::see(const segment::Sighting& s) {
    const std::string comment = comment_of(s.sent);
    const std::int64_t time = options_.epoch_ns + core::to_ns(s.sent.end());
    if (!writer_.write({time, s.sent.bytes(), direction(s.sender), comment, interface_})) ++lost_;
}

}  // namespace dpchip::live
