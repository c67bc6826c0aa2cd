// SPDX-License-Identifier: Apache-2.0
// The DP-V1 driver on the model of the chip, an application with records, and a master that sends raw telegrams.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <dpchip/driver/dpv1.hpp>

#include "driver/on_the_chip.hpp"

namespace dpchip::driver::testing {

struct Dpv1App;
using Dpv1Drv = Vpc3<ChipBus, Dpv1App, 1, Dpv1<4, 8>>;

/// Slot and index name a record; what it says is written down.
struct Dpv1App : AcyclicEvents {
    Dpv1Drv* drv = nullptr;
    int entered = 0, baud = -1;
    std::map<std::pair<int, int>, Octets> records;
    std::map<std::pair<int, int>, dp::RecordError> refusals;
    std::vector<RecordCall> calls;
    std::vector<std::string> heard;
    bool later = false, initiate_later = false;
    int refuse_initiate = -1;
    std::uint16_t send_timeout = 0;
    Handle handle{};
    std::map<int, dp::ImOctets> im;
    Octets outputs = Octets(244);

    void data_exch_entered() { ++entered; }
    void baud_rate_detect(std::uint8_t code) { baud = code; }
    void dx_out() {
        if (drv->fetch_outputs(outputs) != Outputs::unchanged) drv->write_inputs(std::span{outputs}.first(drv->outputs()));
    }

    RecordAnswer read(const RecordCall& c, std::span<std::uint8_t> out) {
        if (const auto answer = decide(c); answer.kind != RecordAnswer::Kind::done) return answer;
        const auto it = records.find({c.slot, c.index});
        if (it == records.end()) return refused(dp::ErrorCode1::invalid_index);
        const std::size_t n = std::min(out.size(), it->second.size());
        std::copy_n(it->second.begin(), n, out.begin());
        return answered(n);
    }
    RecordAnswer write(const RecordCall& c, std::span<const std::uint8_t> data) {
        if (const auto answer = decide(c); answer.kind != RecordAnswer::Kind::done) return answer;
        records[{c.slot, c.index}] = Octets(data.begin(), data.end());
        return answered();
    }
    RecordAnswer data_transport(const RecordCall& c, std::span<const std::uint8_t> data, std::span<std::uint8_t> out) {
        if (const auto answer = decide(c); answer.kind != RecordAnswer::Kind::done) return answer;
        std::reverse_copy(data.begin(), data.end(), out.begin());
        return answered(data.size());
    }
    void request_dropped(Handle h) { heard.push_back("dropped " + std::to_string(h.sap)); }
    void ms1_opened(std::uint8_t m) { heard.push_back("ms1 open " + std::to_string(m)); }
    void ms1_closed() { heard.push_back("ms1 closed"); }
    InitiateAnswer initiate(const InitiateCall& c) {
        handle = c.handle;
        send_timeout = c.send_timeout;
        if (refuse_initiate >= 0) return refuse_connection(static_cast<std::uint8_t>(refuse_initiate));
        return initiate_later ? decide_later() : accept_connection();
    }
    void connection_opened(std::uint8_t sap, std::uint8_t m) { heard.push_back("open " + std::to_string(sap) + " by " + std::to_string(m)); }
    void connection_closed(std::uint8_t sap, ClosedBy by, const dp::Abort& a) {
        constexpr const char* who[]{"master", "driver", "user", "offline"};
        heard.push_back("closed " + std::to_string(sap) + " by " + who[static_cast<int>(by)] + " " + std::to_string(a.reason));
    }
    void alarm_acknowledged(const dp::AlarmAck& a) { heard.push_back("ack " + std::to_string(a.type) + "/" + std::to_string(a.seq_nr())); }
    void alarm_dropped(const dp::AlarmAck& a) { heard.push_back("drop " + std::to_string(a.type) + "/" + std::to_string(a.seq_nr())); }
    bool has_im(std::uint8_t slot, std::uint16_t index) { return slot == 0 && im.count(index) != 0; }
    RecordAnswer read_im(std::uint8_t, std::uint16_t index, std::span<std::uint8_t, 64> out) {
        std::copy(im[index].begin(), im[index].end(), out.begin());
        return answered();
    }
    RecordAnswer write_im(std::uint8_t, std::uint16_t index, std::span<const std::uint8_t, 64> data) {
        if (index == dp::kIm0) return refused(dp::ErrorCode1::access_denied);
        std::copy(data.begin(), data.end(), im[index].begin());
        return answered();
    }
    /// What was heard since the last call.
    std::vector<std::string> news() { return std::exchange(heard, {}); }

private:
    RecordAnswer decide(const RecordCall& c) {
        calls.push_back(c);
        handle = c.handle;
        if (later) return answer_later();
        const auto it = refusals.find({c.slot, c.index});
        return it != refusals.end() ? refused(it->second) : answered();
    }
};

inline constexpr Kind kDpv1Kinds[]{
    {"vpc3c_2k", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::intel},
    {"vpc3c_4k_polled", Variant::vpc3c, RamSize::bytes_4096, Service::polled, BusMode::intel},
    {"vpc3c_motorola", Variant::vpc3c, RamSize::bytes_2048, Service::interrupt, BusMode::motorola},
    {"vpc3b_4k", Variant::vpc3b, RamSize::bytes_4096, Service::interrupt, BusMode::intel},
};

/// Octets from "68 09 09 ..".
inline Octets hex(const std::string& text) {
    Octets out;
    for (std::size_t i = 0; i + 1 < text.size(); ++i)
        if (text[i] != ' ') out.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i++, 2), nullptr, 16)));
    return out;
}

class Dpv1Bench : public Bench<Dpv1App, Dpv1Drv> {
public:
    explicit Dpv1Bench(const Kind& kind = kDpv1Kinds[0]) : Bench{kind} { app.drv = &drv; }

    Config dpv1_config() const {
        Config c = config();
        c.max_prm = 20;
        c.max_diag = 32;
        c.user_timer = UserTimer::ms_10;
        c.dpv1 = {.ms1 = true, .ms1_max_data = 240, .alarm_sap = true, .connections = 3, .ms2_max_data = 240, .alarms = 0xFC,
                  .alarm_sequence = 8, .max_alarm = 16, .identification = true};
        return c;
    }
    /// To DATA-EXCH with DP-V1 and all alarms enabled; the watchdog is off. Leaves the FCB as after two requests.
    void to_dpv1(const Config& c, std::uint8_t status_1 = 0x80, std::uint8_t status_2 = 0xFC, std::uint8_t status_3 = 0x00) {
        power_up(c);
        master_starts(status_1, status_2, status_3);
        app.news();
    }
    void master_starts(std::uint8_t status_1 = 0x80, std::uint8_t status_2 = 0xFC, std::uint8_t status_3 = 0x00) {
        const int before = app.entered;
        ASSERT_EQ(request(61, {0x80, 1, 1, 11, 0x47, 0x11, 0, status_1, status_2, status_3}), sc());
        ASSERT_EQ(request(62, {0x11, 0x21}), sc());
        ASSERT_EQ(app.entered, before + 1);
    }
    void to_dpv1() { to_dpv1(dpv1_config()); }

    /// A request to an acyclic SAP, as the current `master`: what the chip answers at once.
    Octets acyclic(std::uint8_t sap, std::uint8_t ssap, Octets pdu) {
        pdu.insert(pdu.begin(), {sap, ssap});
        return send({static_cast<std::uint8_t>(slave | 0x80), static_cast<std::uint8_t>(master | 0x80), next_fc()}, pdu);
    }
    /// The PDU of a data answer; an empty one for SC. RS and RR are given as their function octet.
    static Octets pdu_of(const Octets& answer) {
        if (answer.size() == 1) return {};
        if (answer.size() == 6) return {answer[3]};
        return answer.size() > 11 ? Octets(answer.begin() + 9, answer.end() - 2) : answer;
    }
    Octets poll(std::uint8_t sap, std::uint8_t ssap) { return pdu_of(acyclic(sap, ssap, {})); }
    /// Request, then polls until there is data.
    Octets ask(std::uint8_t sap, std::uint8_t ssap, Octets pdu) {
        const Octets first = pdu_of(acyclic(sap, ssap, std::move(pdu)));
        return first.empty() ? poll(sap, ssap) : first;
    }
    Octets ms1(Octets pdu) { return ask(51, 51, std::move(pdu)); }

    static Octets initiate_req(std::uint16_t send_timeout = 100) {
        return {0x57, 0, 0, 0, core::high(send_timeout), core::low(send_timeout), 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};
    }
    /// Opens a connection; its SAP, or what SAP 49 answered.
    int open(std::uint16_t send_timeout = 100) {
        const Octets rm = pdu_of(acyclic(49, 50, initiate_req(send_timeout)));
        if (rm.size() != 4 || rm[0] != 0x56) return -(rm.empty() ? 1 : rm[0]);
        const Octets res = poll(rm[1], 50);
        return res.size() == 16 && res[0] == 0x57 ? int{rm[1]} : -0x57;
    }
    Octets ms2(int sap, Octets pdu) { return ask(static_cast<std::uint8_t>(sap), 50, std::move(pdu)); }
    /// A telegram of the reference with the frame count bit that is due; FCS corrected.
    Octets check(const std::string& telegram) {
        Octets t = hex(telegram);
        const std::uint8_t fc_octet = next_fc();
        t[t.size() - 2] = static_cast<std::uint8_t>(t[t.size() - 2] + fc_octet - t[6]);
        t[6] = fc_octet;
        return transmit(t);
    }
    /// A firmware without interrupts looks every millisecond.
    void wait_ms(int ms) {
        for (int i = 0; i < ms; ++i) run(core::milliseconds(1));
    }
};

inline constexpr std::uint8_t kRs = 0x03, kRr = 0x02;

}  // namespace dpchip::driver::testing
