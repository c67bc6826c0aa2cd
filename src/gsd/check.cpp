// SPDX-License-Identifier: Apache-2.0
#include <dpchip/gsd/check.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include <dpchip/dp/cfg.hpp>
#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/set_prm.hpp>

namespace dpchip::gsd {
namespace {

class Checker {
public:
    Checker(Gsd& gsd, std::vector<Diagnostic>& diagnostics) : gsd_{gsd}, diagnostics_{diagnostics} {}

    void run() {
        limits();
        prm_texts();
        parameters();
        user_prm(gsd_.prm, "Max_User_Prm_Data_Len", {});
        user_prm(gsd_.ext_prm, "X_Max_User_Prm_Data_Len", {});
        for (Module& m : gsd_.modules) module(m);
        slots();
    }

private:
    void warn(Position at, std::string message) { diagnostics_.push_back({Severity::warning, at, std::move(message)}); }
    void error(Position at, std::string message) { diagnostics_.push_back({Severity::error, at, std::move(message)}); }

    void limits() {
        if (gsd_.max_diag_data_len < dp::kDiagHeader || gsd_.max_diag_data_len > dp::kMaxDiag)
            warn({}, "Max_Diag_Data_Len " + std::to_string(gsd_.max_diag_data_len) + " is not in 6..244");
        if (gsd_.user_prm_data_len && *gsd_.user_prm_data_len != gsd_.user_prm_data.size())
            warn({}, "User_Prm_Data_Len is " + std::to_string(*gsd_.user_prm_data_len) + ", but User_Prm_Data has " +
                         std::to_string(gsd_.user_prm_data.size()) + " octets");
        if (gsd_.user_prm_data.size() > dp::kMaxUserPrm) error({}, "User_Prm_Data is longer than 237 octets");
        if (gsd_.modules.empty() && gsd_.station_type == 0) warn({}, "no modules");
    }

    void prm_texts() {
        for (const PrmText& t : gsd_.prm_texts)
            if (!texts_.insert(t.number).second)
                warn({}, "PrmText " + std::to_string(t.number) + " is defined again: the last one counts");
    }

    void parameters() {
        for (const Parameter& p : gsd_.parameters) {
            const std::string label = "ExtUserPrmData " + std::to_string(p.number);
            if (!parameters_.insert_or_assign(p.number, &p).second)
                warn(p.at, label + " is defined again: the last one counts");
            if (p.text_ref && !texts_.contains(*p.text_ref))
                warn(p.at, label + ": there is no PrmText " + std::to_string(*p.text_ref));
            if (!p.allows(p.default_value))
                warn(p.at, label + ": the default " + std::to_string(p.default_value) + " is not an allowed value");
        }
    }

    void user_prm(const UserPrm& prm, const char* length_keyword, Position at) {
        const std::size_t limit = prm.length.value_or(dp::kMaxUserPrm);
        std::size_t end = 0;
        for (const PrmConst& c : prm.constants) end = std::max(end, c.offset + c.octets.size());
        for (const PrmRef& r : prm.refs) {
            const auto found = parameters_.find(r.number);
            if (found == parameters_.end()) error(r.at, "there is no ExtUserPrmData " + std::to_string(r.number));
            else end = std::max(end, r.offset + octets(found->second->type));
        }
        if (end > limit)
            warn(at, "parameters take " + std::to_string(end) + " octets, but " + length_keyword + " is " +
                         std::to_string(limit));
    }

    void module(Module& m) {
        if (m.cfg.empty()) return error(m.at, "module without configuration octets");
        if (m.cfg.size() > dp::kMaxCfgOctets) return error(m.at, "module with more than 244 configuration octets");
        const dp::CfgTotals totals = dp::cfg_totals(m.cfg, dp::CfgUse::get_cfg);
        m.input_octets = totals.input_octets;
        m.output_octets = totals.output_octets;
        if (!totals.ok())
            error(m.at, "configuration octet " + std::to_string(totals.error_offset) + ": " + dp::name(totals.error));
        user_prm(m.prm, "Ext_Module_Prm_Data_Len", m.at);
        user_prm(m.ext_prm, "X_Ext_Module_Prm_Data_Len", m.at);
        if (m.reference && !references_.insert(*m.reference).second)
            warn(m.at, "module reference " + std::to_string(*m.reference) + " is used again");
    }

    void slots() {
        for (const SlotRule& s : gsd_.slots)
            if (!references_.contains(s.default_module))
                warn(s.at, "Slot " + std::to_string(s.slot) + ": no module has reference " +
                               std::to_string(s.default_module));
    }

    Gsd& gsd_;
    std::vector<Diagnostic>& diagnostics_;
    std::unordered_set<std::int64_t> texts_, references_;
    std::unordered_map<std::int64_t, const Parameter*> parameters_;
};

}  // namespace

void check(Gsd& gsd, std::vector<Diagnostic>& diagnostics) { Checker{gsd, diagnostics}.run(); }

}  // namespace dpchip::gsd
