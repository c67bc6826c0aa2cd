// SPDX-License-Identifier: Apache-2.0
// Acyclic services: any octets as PDUs, both ways; and a script of telegrams, waiting, alarms and deferred answers for
// the DP-V1 driver on the model of the chip. Whatever is asked, what comes back is a good PDU, every SAP that nobody has
// is locked with empty buffers, and the resource manager is open exactly while a connection is free.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/chip/chip.hpp>
#include <dpchip/dp/identification.hpp>
#include <dpchip/dp/initiate.hpp>
#include <dpchip/driver/dpv1.hpp>
#include <dpchip/fdl/baud.hpp>

namespace {

using namespace dpchip;
using Octets = std::span<const std::uint8_t>;

void require(bool condition) {
    if (!condition) __builtin_trap();
}

// ---- PDUs -----------------------------------------------------------------------------------------------------------

template <class Pdu>
void encodes_back(const dp::AcyclicResult<Pdu>& pdu, Octets octets) {
    if (!pdu) return;
    std::array<std::uint8_t, 256> out{};
    const auto length = dp::encode(*pdu, out);
    require(length && *length <= octets.size());
    // Reserved octets of an Initiate.req and the fourth of an Abort are not kept.
    const bool kept = octets[0] != 0x57 && octets[0] != 0x58;
    require(!kept || std::ranges::equal(octets, std::span{out}.first(*length)));
}

void decode(Octets octets) {
    for (const auto way : {dp::AcyclicDirection::request, dp::AcyclicDirection::answer}) {
        const dp::AcyclicError e = dp::check_pdu(way, octets);
        require(dp::name(e) != nullptr);
    }
    encodes_back(dp::decode_alarm_ack(octets), octets);
    encodes_back(dp::decode_resource_manager(octets), octets);
    encodes_back(dp::decode_negative(octets), octets);
    encodes_back(dp::decode_abort(octets), octets);
    encodes_back(dp::decode_initiate_req(octets), octets);
    encodes_back(dp::decode_initiate_res(octets), octets);
    for (const auto& record : {dp::decode_ds_read_res(octets), dp::decode_ds_write_req(octets), dp::decode_data_transport(octets)})
        require(!record || record->data.size() + dp::kRecordHeader == octets.size());
    if (const auto im = dp::decode_im_call(octets)) require(im->record.empty() || im->record.size() == dp::kImRecord);
    if (octets.size() >= dp::kImRecord) {
        const auto record = octets.first(dp::kImRecord);
        require(std::ranges::equal(dp::encode(*dp::decode_im0(record)), record));
    }
}

// ---- the driver -----------------------------------------------------------------------------------------------------

struct Bus {
    chip::Chip<core::NoTrace>* chip;
    std::uint8_t read(std::uint16_t a) { return chip->read(a); }
    void write(std::uint16_t a, std::uint8_t v) { chip->write(a, v); }
    void read_block(std::uint16_t a, std::span<std::uint8_t> out) { chip->read_block(a, out); }
    void write_block(std::uint16_t a, Octets in) { chip->write_block(a, in); }
};

struct App : driver::AcyclicEvents {
    std::uint8_t mood = 0;  // what to say: bits 1..0, how much: the rest
    driver::Handle last{};

    driver::RecordAnswer say(const driver::RecordCall& call) {
        last = call.handle;
        switch (mood & 3u) {
        case 1: return driver::refused(static_cast<dp::ErrorCode1>(0xA0 + mood / 4));
        case 2: return driver::answer_later();
        default: return driver::answered(mood);
        }
    }
    driver::RecordAnswer read(const driver::RecordCall& call, std::span<std::uint8_t> out) {
        require(out.size() == call.length);
        std::fill(out.begin(), out.end(), mood);
        return say(call);
    }
    driver::RecordAnswer write(const driver::RecordCall& call, Octets data) {
        require(data.size() == call.length && call.length != 0);
        return say(call);
    }
    driver::RecordAnswer data_transport(const driver::RecordCall& call, Octets data, std::span<std::uint8_t> out) {
        std::copy_n(data.begin(), std::min(data.size(), out.size()), out.begin());
        return say(call);
    }
    driver::InitiateAnswer initiate(const driver::InitiateCall& call) {
        last = call.handle;
        if ((mood & 3u) == 1) return driver::refuse_connection(mood & 0x0Fu);
        return (mood & 3u) == 2 ? driver::decide_later() : driver::accept_connection();
    }
    bool has_im(std::uint8_t slot, std::uint16_t index) { return slot == 0 && index <= dp::kIm4; }
    driver::RecordAnswer read_im(std::uint8_t, std::uint16_t, std::span<std::uint8_t, dp::kImRecord> out) {
        std::fill(out.begin(), out.end(), mood);
        return driver::answered();
    }
};

constexpr std::uint8_t kCfg[]{0x11, 0x21};
constexpr std::uint8_t kConnections = 3, kSlave = 8, kSearching = 15, kFirstFc = 0x6D;

class Station {
public:
    Station() {
        regmap::Options options;
        options.baud_probe_ms.fill(1);
        chip_.options() = options;
        driver::Config c{.address = kSlave, .ident = 0x4711, .cfg = kCfg, .max_prm = 16, .max_diag = 40,
                         .user_timer = driver::UserTimer::ms_10, .test_ram = false,
                         .dpv1 = {.ms1 = true, .alarm_sap = true, .connections = kConnections, .ms2_max_data = 64, .alarms = 0xFC,
                                  .alarm_sequence = 4, .max_alarm = 20, .identification = true}};
        require(driver_.configure(c) == driver::ConfigError::none && driver_.start());
        come_up();
    }
    /// One step; how many octets of the script it has used.
    std::size_t step(Octets script) {
        const std::uint8_t op = script[0];
        const std::uint8_t more = script.size() > 1 ? script[1] : std::uint8_t{0};
        std::size_t used = 2;
        switch (op & 7u) {
        case 0: app_.mood = more; break;
        case 1: wait(core::milliseconds(more * 16)); break;
        case 2: finish(more); break;
        case 3: disturb(more); break;
        default: used = telegram(op, script.subspan(1)) + 1; break;
        }
        wait(core::microseconds(10));  // X/INT may have to stay inactive for a while before it tells the rest
        check();
        return used;
    }

private:
    void come_up() {
        for (int i = 0; i < 400 && driver_.baud_code() == kSearching; ++i) {
            send(2, {}, 0x49, {});
            wait(core::microseconds(100));
        }
        const std::uint8_t prm[]{61, 62, 0x80, 1, 1, 11, 0x47, 0x11, 0, 0x80, 0xFC, 0x03};
        const std::uint8_t cfg[]{62, 62, 0x11, 0x21};
        request(2, prm);
        request(2, cfg);
        request_default(2);
    }
    /// op bits 3: master, 5..4: which SAP, 7..6: how the PDU begins.
    std::size_t telegram(std::uint8_t op, Octets script) {
        constexpr std::uint8_t kSaps[]{51, 50, 49, 48};
        constexpr std::uint8_t kFirst[]{0x5E, 0x5F, 0x57};
        const std::uint8_t head = script.empty() ? std::uint8_t{0} : script[0];
        std::vector<std::uint8_t> data{kSaps[op >> 4 & 3], 50};
        if (data[0] == 48) data[0] = static_cast<std::uint8_t>(48 - head % kConnections);
        if (data[0] >= 50) data[1] = 51;
        const std::size_t octets = std::min<std::size_t>(head / 2, script.size() - std::min<std::size_t>(1, script.size()));
        for (std::size_t i = 0; i < octets; ++i) data.push_back(script[1 + i]);
        if (octets != 0 && (op >> 6) != 0) data[2] = kFirst[(op >> 6) - 1];
        request((op & 8u) != 0 ? std::uint8_t{3} : std::uint8_t{2}, data);
        return 1 + octets;
    }
    void finish(std::uint8_t how) {
        const std::array<std::uint8_t, 255> data{how};
        if ((how & 1u) != 0) driver_.complete(app_.last, driver::accept_connection());
        else if ((how & 2u) != 0) driver_.complete(app_.last, driver::refused(dp::ErrorCode1::resource_busy));
        else driver_.complete(app_.last, driver::answered(how), Octets{data}.first(how));
    }
    void disturb(std::uint8_t how) {
        const std::array<std::uint8_t, 20> data{};
        dp::AlarmStatus alarm{};
        switch (how & 7u) {
        case 0: driver_.leave_master(); break;
        case 1:
            driver_.restart();
            wait(core::milliseconds(1));
            return come_up();
        case 2: driver_.abort_connection(static_cast<std::uint8_t>(48 - how / 8 % 4), how & 0x0Fu); break;
        case 3: driver_.set_diagnosis(Octets{data}.first(how / 16), {.ext_diag = true}); break;
        case 4: request_default(2); break;
        case 5: come_up(); break;
        default:
            alarm.status = (how & 1u) != 0;
            alarm.type = static_cast<std::uint8_t>(1 + how / 8 % 7);
            alarm.data = Octets{data}.first(how / 16);
            driver_.raise(alarm);
        }
        serve();
    }
    /// What must be true between any two steps.
    void check() {
        if (driver_.state() != driver::State::online) return;
        const auto& l = driver_.dpv1().layout();
        int closed = 0;
        for (std::uint8_t n = 0; n < kConnections; ++n) {
            const auto ch = static_cast<std::uint8_t>(driver::channel::connection0 + n);
            if (driver_.dpv1().connection(n) != driver::detail::C2State::closed) continue;
            ++closed;
            require(octet(l.entry(ch) + 1u) == kSlave);
            require(octet(l.address(l.request_buffer(ch))) == 0 && octet(l.address(l.second_buffer(ch))) == 0);
        }
        const std::uint16_t rm = l.entry(driver::channel::resource_manager);
        require((octet(rm + 1u) == kSlave) == (closed == 0));
        require((octet(l.address(l.answer_buffer(driver::channel::resource_manager))) == 0xA0) == (closed != 0));
        require((octet(l.entry(driver::channel::ms1) + 1u) == kSlave) == !driver_.dpv1().ms1_open());
        require(!driver_.dpv1().ms1_open() || driver_.dp_state() != 0);
    }
    std::uint8_t octet(unsigned address) const { return chip_.peek(static_cast<std::uint16_t>(address)); }

    // ---- the line
    /// A request without an answer ends the sequence of frame count bits.
    std::uint8_t next_fc() {
        const std::uint8_t now = fc_;
        fc_ = now == 0x5D ? 0x7D : 0x5D;
        return now;
    }
    void request(std::uint8_t master, Octets data) {
        const bool listens = driver_.baud_code() != kSearching;
        const std::vector<std::uint8_t> answer = send(master, data, next_fc(), data);
        require(!answer.empty() || !listens);
        if (answer.empty()) fc_ = kFirstFc;
        if (answer.size() > 11 && data[0] <= 51) {
            const Octets pdu = Octets{answer}.subspan(9, answer.size() - 11);
            require(dp::check_pdu(dp::AcyclicDirection::answer, pdu) == dp::AcyclicError::none || pdu[0] == 0x5F);
        }
    }
    void request_default(std::uint8_t master) {
        const std::uint8_t outputs[]{0, 0};
        if (send(master, {}, next_fc(), outputs).empty()) fc_ = kFirstFc;
    }
    /// With SAPs when `saps` is not empty.
    std::vector<std::uint8_t> send(std::uint8_t master, Octets saps, std::uint8_t fc, Octets unit) {
        const std::uint8_t ext = saps.empty() ? 0 : 0x80;
        const auto le = static_cast<std::uint8_t>(3 + unit.size());
        std::vector<std::uint8_t> t = unit.empty() ? std::vector<std::uint8_t>{0x10} : std::vector<std::uint8_t>{0x68, le, le, 0x68};
        const std::size_t first = t.size();
        t.insert(t.end(), {static_cast<std::uint8_t>(kSlave | ext), static_cast<std::uint8_t>(master | ext), fc});
        t.insert(t.end(), unit.begin(), unit.end());
        std::uint8_t fcs = 0;
        for (std::size_t i = first; i < t.size(); ++i) fcs = static_cast<std::uint8_t>(fcs + t[i]);
        t.insert(t.end(), {fcs, 0x16});
        return transmit(t);
    }
    std::vector<std::uint8_t> transmit(Octets octets) {
        const core::Ticks bit = fdl::baud(fdl::BaudCode::mbit_12).bit;
        wait(bit * 60);
        fdl::Transmission t;
        t.assign(chip_.now(), bit, octets);
        chip_.carrier(t.start);
        wait(t.end() - chip_.now());
        chip_.hear(t);
        const core::Ticks patience = chip_.now() + bit * 400;
        fdl::Transmission answer;
        while (chip_.next() <= patience) {
            advance(chip_.next());
            if (!chip_.take(answer)) continue;
            wait(answer.end() - chip_.now());
            return {answer.bytes().begin(), answer.bytes().end()};
        }
        advance(patience);
        return {};
    }
    void wait(core::Ticks duration) {
        const core::Ticks end = chip_.now() + duration;
        while (chip_.next() <= end) advance(chip_.next());
        advance(end);
    }
    void advance(core::Ticks to) {
        chip_.advance(to);
        serve();
    }
    void serve() {
        for (int i = 0; i < 10 && chip_.interrupt_active(); ++i) driver_.on_interrupt();
    }

    chip::Chip<core::NoTrace> chip_;
    App app_;
    driver::Vpc3<Bus, App, 1, driver::Dpv1<kConnections, 4>> driver_{Bus{&chip_}, app_};
    std::uint8_t fc_ = kFirstFc;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Octets in{data, size};
    decode(in.first(std::min<std::size_t>(size, 244)));
    if (size > 4096) return 0;
    Station station;
    while (!in.empty()) in = in.subspan(std::min(in.size(), station.step(in)));
    return 0;
}
