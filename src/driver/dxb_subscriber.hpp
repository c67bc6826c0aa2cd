// SPDX-License-Identifier: Apache-2.0
// The firmware's part of DXB: buffers, links from parameter blocks, samples, link status (VPC3+C 7.3.1; reference 6.1).
// Stands beside Vpc3 and shares its bus; the application connects them:
//
//   own_interrupts()  ->  DxbSubscriber::kInterrupts
//   after configure() ->  configure() with the first free address of the RAM
//   set_prm()         ->  forget(), then add() for each block; set_ext_prm(): add() only; refuse when add() does not like one
//   serve_own()       ->  serve(), then fetch() until it says no
//
// Several links to one publisher share one set of three buffers: of one broadcast only the last link's sample is seen.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/bits.hpp>
#include <dpchip/dp/dxb_prm.hpp>
#include <dpchip/driver/bus_port.hpp>
#include <dpchip/driver/layout.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::driver {

/// How many links a master may give the station, and how long a sample may be. VPC3+B and VPC3+C.
struct DxbConfig {
    std::uint8_t max_links = 0;   ///< 0: no subscriber; at most 29
    std::uint8_t max_sample = 0;  ///< 1..244 octets
};

/// What one publisher has sent, cut to the link.
struct DxbSample {
    std::uint8_t publisher{};
    std::span<const std::uint8_t> octets{};  ///< valid until the next fetch()
};

template <BusPort Bus>
class DxbSubscriber {
public:
    static constexpr std::uint16_t kInterrupts = regmap::interrupt::dxb_out | regmap::interrupt::dxb_link_error;

    explicit DxbSubscriber(Bus bus) : bus_{bus} {}

    /// Octets of RAM that the buffers take.
    static constexpr std::uint16_t room(const DxbConfig& c, std::uint8_t shift) {
        const std::size_t segment = std::size_t{1} << shift;
        const auto whole = [segment](std::size_t octets) { return (octets + segment - 1) / segment * segment; };
        const std::size_t sample = std::size_t{c.max_sample} + 2, links = std::size_t{c.max_links} * 4;
        if (c.max_links == 0) return 0;
        return static_cast<std::uint16_t>(3 * whole(sample) + whole(links) + whole(dp::dxb_status_octets(c.max_links)));
    }

    /// Lays the buffers out from `first` on, below `end`. After Vpc3::configure(), before start(). False when the figures
    /// are out of range, or the RAM is too small.
    bool configure(const DxbConfig& config, const Layout& layout, std::uint16_t first, std::uint16_t end) {
        if (config.max_links > dp::kMaxDxbLinks || (config.max_links != 0 && (config.max_sample == 0 || config.max_sample > dp::kMaxPublished))) return false;
        const unsigned segment = 1u << layout.shift;
        unsigned at = (first + segment - 1) & ~(segment - 1);
        if (at + room(config, layout.shift) > end) return false;
        config_ = config;
        shift_ = layout.shift;
        count_ = 0;
        if (config.max_links == 0) return true;
        const auto take = [&](std::size_t octets) {
            const auto begin = static_cast<std::uint16_t>(at);
            at = (at + static_cast<unsigned>(octets) + segment - 1) & ~(segment - 1);
            return begin;
        };
        for (std::uint16_t& buffer : out_) buffer = take(config.max_sample + 2u);
        link_ = take(config.max_links * 4u);
        status_ = take(dp::dxb_status_octets(config.max_links));
        write_cells();
        return true;
    }

    // ---- parameters -----------------------------------------------------------------------------------------------
    /// No links any more.
    void forget() {
        count_ = 0;
        if (config_.max_links != 0) write_links();
    }
    /// Takes the links of one block; blocks of other types are none of its business. With an error nothing is taken.
    /// `wd_on`: WD_On of the Set_Prm, without which links are not monitored.
    dp::DxbError add(const dp::PrmBlock& block, bool wd_on) {
        const auto table = dp::DxbTable::of(block);
        if (!table) return table.error() == dp::DxbError::type ? dp::DxbError::none : table.error();
        if (!wd_on) return dp::DxbError::watchdog;
        if (count_ + table->size() > config_.max_links) return dp::DxbError::length;
        for (std::size_t i = 0; i < table->size(); ++i) {
            const dp::DxbLink link = (*table)[i];
            if (const dp::DxbError error = dp::check(link); error != dp::DxbError::none) return error;
            if (link.sample_length > config_.max_sample) return dp::DxbError::sample;
        }
        for (std::size_t i = 0; i < table->size(); ++i) links_[count_++] = (*table)[i];
        write_links();
        return dp::DxbError::none;
    }
    std::span<const dp::DxbLink> links() const { return std::span{links_}.first(count_); }

    // ---- events ---------------------------------------------------------------------------------------------------
    /// Acknowledges what of `irr` is DXB's and returns it: DXB_Out wants fetch(), DXB_Link_Error wants link_status().
    std::uint16_t serve(std::uint16_t irr) {
        const auto mine = static_cast<std::uint16_t>(irr & kInterrupts);
        if (mine != 0) bus_.write(acknowledge_, core::low(mine));
        return mine;
    }
    /// The newest sample; false when it has been fetched before.
    bool fetch(DxbSample& sample) {
        if (config_.max_links == 0) return false;
        const std::uint8_t answer = bus_.read(regmap::control::next_dxbout_buffer_cmd), u = answer & 3u;
        if ((answer & regmap::next_dout::state_u_buffer) == 0 || u == 0) return false;
        const std::uint16_t from = out_[u - 1u];
        const std::size_t octets = std::min(bus_.read(static_cast<std::uint16_t>(from + 1)), config_.max_sample);
        sample.publisher = bus_.read(from);
        bus_.read_block(static_cast<std::uint16_t>(from + 2), std::span{sample_}.first(octets));
        sample.octets = std::span{sample_}.first(octets);
        return true;
    }
    /// Link_Status octet of link `n` (dp::kLinkStatus and its kind).
    std::uint8_t link_status(std::size_t n) { return bus_.read(static_cast<std::uint16_t>(status_ + 5 + 2 * n)); }
    /// The status message DXB_Link_Status as the chip keeps it, for the diagnosis; returns its octets, 0 without links or
    /// when `out` is too small.
    std::size_t status_message(std::span<std::uint8_t> out) {
        const std::size_t octets = dp::dxb_status_octets(count_);
        if (count_ == 0 || out.size() < octets) return 0;
        bus_.read_block(status_, out.first(octets));
        return octets;
    }
    /// In Motorola mode the word registers are swapped.
    void set_bus_mode(BusMode mode) {
        acknowledge_ = mode == BusMode::motorola ? regmap::control::int_ack_reg_high : regmap::control::int_ack_reg_low;
    }

private:
    void write_cells() {
        namespace org = regmap::org;
        const auto segment = [&](std::uint16_t address) { return static_cast<std::uint8_t>(address >> shift_); };
        bus_.write(org::r_len_dxbout_buf, static_cast<std::uint8_t>(config_.max_sample + 2u));
        bus_.write(org::r_dxbout_buf_ptr1, segment(out_[0]));
        bus_.write(org::r_dxbout_buf_ptr2, segment(out_[1]));
        bus_.write(org::r_dxbout_buf_ptr3, segment(out_[2]));
        bus_.write(org::r_dxb_link_buf_ptr, segment(link_));
        bus_.write(org::r_dxb_status_buf_ptr, segment(status_));
        bus_.write(org::r_len_dxb_link_buf, 0);
        bus_.write(org::r_len_dxb_status_buf, 0);
    }
    /// The chip looks at the tables at any time: their lengths are 0 while they are written.
    void write_links() {
        namespace org = regmap::org;
        bus_.write(org::r_len_dxb_link_buf, 0);
        std::uint16_t to = link_;
        for (const dp::DxbLink& l : links())
            for (const std::uint8_t octet : {l.publisher, l.publisher_length, l.sample_offset, l.sample_length}) bus_.write(to++, octet);
        std::array<std::uint8_t, dp::dxb_status_octets(dp::kMaxDxbLinks)> status{};
        const std::size_t octets = count_ == 0 ? 0 : dp::encode_dxb_status(links(), status);
        bus_.write_block(status_, std::span{status}.first(octets));
        bus_.write(org::r_len_dxb_status_buf, static_cast<std::uint8_t>(octets));
        bus_.write(org::r_len_dxb_link_buf, static_cast<std::uint8_t>(count_ * 4));
    }

    Bus bus_;
    DxbConfig config_{};
    std::uint8_t shift_ = 3;
    std::uint16_t acknowledge_ = regmap::control::int_ack_reg_low;
    std::array<std::uint16_t, 3> out_{};
    std::uint16_t link_ = 0, status_ = 0;
    std::size_t count_ = 0;
    std::array<dp::DxbLink, dp::kMaxDxbLinks> links_{};
    std::array<std::uint8_t, dp::kMaxPublished> sample_{};
};

}  // namespace dpchip::driver
