// SPDX-License-Identifier: Apache-2.0
// Pairing answers with requests.
#include <dpchip/trace/dialogue.hpp>

namespace dpchip::trace {

std::vector<Utterance> split(std::span<const std::uint8_t> octets) {
    std::vector<Utterance> result;
    for (std::size_t at = 0; at < octets.size();) {
        const auto rest = octets.subspan(at);
        const auto telegram = fdl::decode(rest);
        if (telegram) {
            result.push_back({at, rest.first(telegram->size), true, {}});
            at += telegram->size;
            continue;
        }
        const std::size_t dropped = fdl::resync(rest);
        if (!result.empty() && !result.back().good && telegram.error() == fdl::Reject::start_delimiter) {
            Utterance& damage = result.back();
            damage.octets = octets.subspan(damage.offset, damage.octets.size() + dropped);
        } else {
            result.push_back({at, rest.first(dropped), false, telegram.error()});
        }
        at += dropped;
    }
    return result;
}

Explanation Dialogue::next(const fdl::Telegram& telegram) {
    if (answers(telegram, open_)) {
        Explanation result = explain(telegram, {open_, false, texts_});
        open_ = {};
        return result;
    }
    const Request request = request_of(telegram);
    // Whatever else is heard ends the wait: a token, a foreign answer, a telegram without answer.
    open_ = request;
    return explain(telegram, {{}, repeated(telegram), texts_});
}

Explanation Dialogue::next(std::span<const std::uint8_t> octets) {
    const auto telegram = fdl::decode(octets);
    if (telegram && telegram->size == octets.size()) return next(*telegram);
    return explain_reject(telegram ? fdl::Reject::length_mismatch : telegram.error(), octets);
}

/// The responder's rule: valid frame count, same sender, same bit as before.
bool Dialogue::repeated(const fdl::Telegram& t) {
    if (!t.has_fc() || !t.fc.is_request() || !fdl::uses_frame_count(t.fc.request()) || t.destination() == fdl::kBroadcast)
        return false;
    FrameCount& last = frame_count_[t.destination()];
    if (!t.fc.fcv()) {
        last = {t.fc.fcb(), t.source(), t.fc.fcb()};
        return false;
    }
    const bool same = last.valid && last.sa == t.source() && last.fcb == t.fc.fcb();
    last = {true, t.source(), t.fc.fcb()};
    return same;
}

}  // namespace dpchip::trace
