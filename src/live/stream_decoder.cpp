// SPDX-License-Identifier: Apache-2.0
// Finding telegrams in a stream of octets.
#include <algorithm>

#include <dpchip/live/stream_decoder.hpp>

namespace dpchip::live {
namespace {

constexpr bool checked_start(std::uint8_t octet) {
    return octet == fdl::kSd1 || octet == fdl::kSd2 || octet == fdl::kSd3;
}
constexpr bool is_start(std::uint8_t octet) {
    return checked_start(octet) || octet == fdl::kSd4 || octet == fdl::kSc;
}

}  // namespace

std::size_t StreamDecoder::feed(std::span<const std::uint8_t> octets, std::span<const std::uint8_t> faults, Ticks at) {
    if (begin_ != 0) {
        std::copy(octets_.begin() + static_cast<std::ptrdiff_t>(begin_), octets_.begin() + static_cast<std::ptrdiff_t>(size_), octets_.begin());
        std::copy(faults_.begin() + static_cast<std::ptrdiff_t>(begin_), faults_.begin() + static_cast<std::ptrdiff_t>(size_), faults_.begin());
        std::copy(at_.begin() + static_cast<std::ptrdiff_t>(begin_), at_.begin() + static_cast<std::ptrdiff_t>(size_), at_.begin());
        size_ -= begin_;
        begin_ = 0;
    }
    const std::size_t taken = std::min(octets.size(), kCapacity - size_);
    for (std::size_t i = 0; i < taken; ++i) {
        octets_[size_] = octets[i];
        faults_[size_] = i < faults.size() ? faults[i] : std::uint8_t{0};
        at_[size_++] = at;
    }
    return taken;
}

std::optional<Piece> StreamDecoder::next(Ticks now) {
    if (begin_ == size_) return std::nullopt;
    const Step step = examine(now >= deadline());
    if (step.octets == 0) return std::nullopt;
    const std::size_t from = begin_;
    begin_ += step.octets;
    in_damage_ = !step.good;
    last_ = at_[begin_ - 1];
    return Piece{step.good, step.reason, at_[begin_ - 1], {octets_.data() + from, step.octets},
                 {faults_.data() + from, step.octets}};
}

Ticks StreamDecoder::deadline() const { return begin_ == size_ ? core::kNever : at_[size_ - 1] + give_up_; }

StreamDecoder::Step StreamDecoder::examine(bool final) const {
    const auto rest = octets(begin_);
    // Behind damage only silence makes a telegram without frame check sequence credible again.
    if (in_damage_ && at_[begin_] - last_ < pause_ && !checked_start(rest[0])) return broken(fdl::Reject::start_delimiter, 1);
    const auto size = fdl::telegram_size(rest);
    if (!size && size.error() != fdl::Reject::need_more) return broken(size.error(), 1);
    if (!size || rest.size() < *size) return unfinished(final);
    for (std::size_t i = 0; i < *size; ++i)
        if (faults_[begin_ + i] != 0) return broken(fdl::Reject::parity, *size);
    const auto telegram = fdl::decode(rest);
    if (telegram) return {*size, true, {}};
    return broken(telegram.error(), *size);
}

/// Damage that reaches to the next place where a telegram may begin. `frame`: octets of a telegram that has its shape
/// but is damaged; its inside is data, unless a telegram begins there that reaches to its end or beyond.
StreamDecoder::Step StreamDecoder::broken(fdl::Reject reason, std::size_t frame) const {
    const bool shaped = frame > 1 && octets_[begin_ + frame - 1] == fdl::kEd;
    for (std::size_t i = next_start(begin_ + 1); i < size_; i = next_start(i + 1)) {
        if (!shaped || i >= begin_ + frame) return {i - begin_, false, reason};
        const auto size = fdl::telegram_size(octets(i));
        const bool open = !size && size.error() == fdl::Reject::need_more;
        const bool reaches = size && i + *size >= begin_ + frame;
        if (open || (reaches && (i + *size > size_ || fdl::decode(octets(i))))) return {i - begin_, false, reason};
    }
    return {size_ - begin_, false, reason};
}

/// The head may still become a telegram, unless time is over or a good telegram stands behind a pause.
StreamDecoder::Step StreamDecoder::unfinished(bool final) const {
    for (std::size_t i = begin_ + 1; i < size_; ++i)
        if (at_[i] - at_[i - 1] >= pause_ && checked_start(octets_[i]) && credible(i))
            return {i - begin_, false, fdl::Reject::need_more};
    if (final) return broken(fdl::Reject::need_more, 1);
    return {0, false, fdl::Reject::need_more};
}

/// A whole, faultless telegram begins at `at`.
bool StreamDecoder::credible(std::size_t at) const {
    const auto telegram = fdl::decode(octets(at));
    if (!telegram) return false;
    return std::all_of(faults_.begin() + static_cast<std::ptrdiff_t>(at),
                       faults_.begin() + static_cast<std::ptrdiff_t>(at + telegram->size), [](std::uint8_t f) { return f == 0; });
}

/// The next octet that a telegram may begin with: any delimiter behind a pause, else one whose telegram is checked.
std::size_t StreamDecoder::next_start(std::size_t from) const {
    for (std::size_t i = from; i < size_; ++i)
        if (checked_start(octets_[i]) || (is_start(octets_[i]) && at_[i] - at_[i - 1] >= pause_)) return i;
    return size_;
}

}  // namespace dpchip::live
