// SPDX-License-Identifier: Apache-2.0
// The master's cycle: what comes next, and when. The single request and its answer are in message_cycle.cpp.
#include <dpchip/master/master.hpp>

#include <algorithm>

namespace dpchip::master {

namespace {

bool unset(const fdl::BusTimes& t) { return t.tsl == 0; }

core::Result<bool, ConfigError> check(const SlaveConfig& s) {
    if (s.address > dp::kMaxSlaveAddress) return ConfigError::address;
    if (s.cfg.empty()) return ConfigError::no_cfg;
    if (s.user_prm.size() > dp::kMaxUserPrm || s.cfg.size() > 244 || s.input_octets > 244 || s.output_octets > 244)
        return ConfigError::too_long;
    const bool ms_1 = !s.user_prm.empty() && (s.user_prm[0] & dp::kWdBase1ms) != 0;
    if (!dp::wd_factors(s.watchdog_ms, ms_1 ? dp::WdBase::ms_1 : dp::WdBase::ms_10)) return ConfigError::watchdog;
    return true;
}

}  // namespace

Master::Master(const MasterConfig& config) : config_{config}, mode_{config.mode} {
    if (unset(config_.times)) config_.times = fdl::bus_times(config_.baud);
    config_.address = std::min<std::uint8_t>(config_.address, dp::kMaxSlaveAddress);
    config_.max_retry = std::min<std::uint8_t>(config_.max_retry, 15);
    config_.hsa = std::min(config_.hsa, kLastAddress);
    config_.acyclic_per_cycle = std::max<std::uint8_t>(config_.acyclic_per_cycle, 1);
    bit_ = fdl::baud(config_.baud).bit;
    slot_ = config_.slot_time == Ticks{} ? bits(config_.times.tsl) : config_.slot_time;
    min_cycle_ = config_.min_cycle;
    random_ = config_.isochron.seed | 1;
    by_address_.fill(-1);
    if (mode_ != Mode::offline) take_bus();
}

core::Result<std::size_t, ConfigError> Master::add(const SlaveConfig& slave) {
    const auto good = check(slave);
    if (!good) return good.error();
    if (slave.address == config_.address || by_address_[slave.address] >= 0) return ConfigError::address_taken;
    by_address_[slave.address] = static_cast<std::int16_t>(slaves_.size());
    SlaveConfig own = slave;
    if (own.publisher) {
        own.user_prm.resize(std::max<std::size_t>(own.user_prm.size(), 3));
        own.user_prm[0] |= dp::kPublisherEnable;
        own.min_tsdr = static_cast<std::uint8_t>(std::clamp<std::int64_t>(config_.times.publisher_min_tsdr(), own.min_tsdr, 255));
    }
    slaves_.push_back(std::make_unique<SlaveHandler>(own));
    min_cycle_ = std::max(min_cycle_, slave.min_slave_interval);
    return slaves_.size() - 1;
}

SlaveHandler* Master::find(std::uint8_t address) {
    if (address > kLastAddress || by_address_[address] < 0) return nullptr;
    return slaves_[static_cast<std::size_t>(by_address_[address])].get();
}

std::size_t Master::exchanging() const {
    return static_cast<std::size_t>(std::ranges::count_if(slaves_, [](const auto& s) { return s->exchanging(); }));
}

void Master::set_mode(Mode mode) {
    const Mode before = mode_;
    mode_ = mode;
    if (mode == Mode::offline) {
        if (job_ != nullptr) job_finished(Job::Outcome::unanswered);
        phase_ = Phase::silent;
        outstanding_ = false;
        announced_ = Mode::stop;
    } else if (before == Mode::offline) {
        take_bus();
    }
}

bool Master::take_over(const Master& primary) {
    const auto same = [](const auto& a, const auto& b) { return a->config().address == b->config().address && a->config().ident == b->config().ident; };
    if (mode_ != Mode::offline || primary.config_.address != config_.address) return false;
    if (!std::ranges::equal(slaves_, primary.slaves_, same)) return false;
    for (std::size_t n = 0; n < slaves_.size(); ++n) *slaves_[n] = *primary.slaves_[n];
    frames_ = primary.frames_;
    mode_ = primary.mode_;
    announced_ = primary.announced_;
    event_time_ = primary.event_time_;
    previous_event_ = primary.previous_event_;
    now_ = std::max(now_, primary.now_);
    if (mode_ != Mode::offline) take_bus();
    return true;
}

bool Master::global_control(const dp::GlobalControl& command) {
    if (commands_.size() == commands_.capacity()) return false;
    commands_.push(command);
    return true;
}

// ---- time --------------------------------------------------------------------------------------------------------

Ticks Master::next() const {
    switch (phase_) {
    case Phase::silent: return core::kNever;
    case Phase::waiting:
    case Phase::draining: return send_at_;
    case Phase::ready: return now_;
    case Phase::asking:
    case Phase::hearing: return deadline_;
    }
    return core::kNever;
}

void Master::advance(Ticks t) {
    now_ = t;
    if ((phase_ == Phase::asking || phase_ == Phase::hearing) && t >= deadline_) no_answer();
    if (phase_ == Phase::draining && t >= send_at_) {
        const bool token = step_ == Step::token || step_ == Step::pass;
        if (step_ == Step::job) job_finished(Job::Outcome::acknowledged);
        step_done(own_end_, token ? config_.times.tid1() : config_.times.tid2());
    }
    if (phase_ == Phase::waiting && t >= send_at_) {
        if (step_ == Step::claim) {
            synch_at_ = clock_due_ = now_;
            begin_cycle();
        }
        phase_ = Phase::ready;
    }
}

// ---- the cycle ---------------------------------------------------------------------------------------------------

/// Listens until the bus has been silent for as long as no other master would be (TTO).
void Master::take_bus() {
    step_ = Step::claim;
    phase_ = Phase::waiting;
    outstanding_ = false;
    cycle_measured_ = false;
    send_at_ = now_ + bits(config_.times.tsl * (6 + 2 * config_.address));
}

void Master::begin_cycle() {
    step_ = isochron() ? Step::synch : Step::token;
    turn_ = 0;
    absent_left_ = std::min<std::size_t>(config_.absent_polls, slaves_.size());
    acyclic_left_ = config_.acyclic_per_cycle;
    if (mode_ == announced_) return;
    announced_ = mode_;
    if (mode_ == Mode::clear) global_control({dp::kGcClearData, 0});
    if (mode_ == Mode::operate) global_control({0, 0});
}

/// The next place on the grid of SYNCHs that is not too early, and the jitter on top.
Ticks Master::synch_time(Ticks earliest) {
    const IsochronCycle& i = config_.isochron;
    synch_at_ += i.cycle;
    for (; synch_at_ < earliest; synch_at_ += i.cycle) ++cycle_.overruns;
    if (i.jitter == Ticks{}) return synch_at_;
    random_ ^= random_ << 13;
    random_ ^= random_ >> 7;
    random_ ^= random_ << 17;
    return synch_at_ + Ticks{static_cast<std::int64_t>(random_ % (static_cast<std::uint64_t>(i.jitter.n) + 1))};
}

/// An acyclic request, its longest answer and the token are over before the next SYNCH. Repetitions are not reckoned with.
bool Master::fits_in_cycle() const {
    if (!isochron()) return true;
    const auto characters = static_cast<std::int64_t>(fdl::kMaxTelegram) + 64;
    return present() + slot_ + bits(fdl::kCharacterBits * characters) + bits(2 * config_.times.tid2()) <= synch_at_ + config_.isochron.cycle;
}

/// The next part of the cycle that has something to do; the end of one cycle is the beginning of another.
void Master::choose() {
    while (!step_has_work()) {
        if (step_ != Step::end) {
            step_ = static_cast<Step>(static_cast<unsigned>(step_) + 1);
            continue;
        }
        if (hook_ != nullptr) hook_(hook_context_, *this);
        begin_cycle();
        return;
    }
}

bool Master::step_has_work() {
    switch (step_) {
    case Step::claim:
    case Step::synch:
    case Step::token:
    case Step::end: return false;
    case Step::pass: return isochron();
    case Step::time_event:
        if (config_.time.interval == Ticks{} || present() < clock_due_) return false;
        clock_due_ += config_.time.interval;
        clock_value_due_ = true;
        return true;
    case Step::clock_value: return clock_value_due_;
    case Step::slave:
        if (!active()) return false;
        while (turn_ < slaves_.size() && slaves_[turn_]->given_up()) ++turn_;
        return turn_ < slaves_.size();
    case Step::absent: return active() && absent_left_ != 0 && absent_due();
    case Step::command:
        if (commands_.empty()) return false;
        command_ = commands_.pop();
        return true;
    case Step::job: return acyclic_left_ != 0 && fits_in_cycle() && acyclic_due();
    case Step::scan:
        if (!scanning() || !fits_in_cycle()) return false;
        job_ = &scan_job_;
        return true;
    case Step::gap:
        if (config_.gap_factor == 0 || !fits_in_cycle() || ++gap_count_ < config_.gap_factor) return false;
        gap_count_ = 0;
        gap_address_ = gap_address_ >= config_.hsa ? std::uint8_t{0} : static_cast<std::uint8_t>(gap_address_ + 1);
        return gap_address_ != config_.address && by_address_[gap_address_] < 0;
    }
    return false;
}

/// Moves absent_turn_ to the next slave that has been given up.
bool Master::absent_due() {
    for (std::size_t n = 1; n <= slaves_.size(); ++n) {
        const std::size_t candidate = (absent_turn_ + n) % slaves_.size();
        if (!slaves_[candidate]->given_up()) continue;
        absent_turn_ = candidate;
        return true;
    }
    return false;
}

/// Jobs and relations take turns.
bool Master::acyclic_due() {
    if (relations_first_) return relation_due() || job_due();
    return job_due() || relation_due();
}

bool Master::job_due() {
    if (jobs_.empty()) return false;
    job_ = jobs_.pop();
    relations_first_ = true;
    return true;
}

bool Master::relation_due() {
    for (std::size_t n = relations_.size(); n != 0; --n) {
        if (relation_turn_ >= relations_.size()) relation_turn_ = 0;
        Relation* const relation = relations_[relation_turn_++];
        job_ = relation->next_job(present());
        if (job_ == nullptr) continue;
        asking_ = relation;
        relations_first_ = false;
        return true;
    }
    return false;
}

/// The present step is through; the line is quiet from `end` on and must be for `idle_bits`.
void Master::step_done(Ticks end, std::int64_t idle_bits) {
    outstanding_ = false;
    switch (step_) {
    case Step::slave: ++turn_; break;
    case Step::absent: --absent_left_; break;
    case Step::command: break;
    case Step::job: --acyclic_left_; break;
    case Step::clock_value: break;
    case Step::synch: step_ = Step::slave; break;
    case Step::claim:
    case Step::token:
    case Step::time_event:
    case Step::pass:
    case Step::scan:
    case Step::gap:
    case Step::end: step_ = static_cast<Step>(static_cast<unsigned>(step_) + (step_ == Step::end ? 0u : 1u)); break;
    }
    phase_ = Phase::waiting;
    choose();
    if (mode_ == Mode::offline) {  // the hook may have said so
        phase_ = Phase::silent;
        return;
    }
    send_at_ = std::max(end, own_end_) + bits(idle_bits);
    if (step_ == Step::token) send_at_ = std::max(send_at_, cycle_start_ + min_cycle_);
    if (step_ == Step::synch) send_at_ = synch_time(send_at_);
}

/// A token begins now.
void Master::measure() {
    if (cycle_measured_) {
        cycle_.last = now_ - cycle_start_;
        cycle_.min = std::min(cycle_.min, cycle_.last);
        cycle_.max = std::max(cycle_.max, cycle_.last);
        ++cycle_.cycles;
    }
    cycle_measured_ = true;
    cycle_start_ = now_;
}

}  // namespace dpchip::master
