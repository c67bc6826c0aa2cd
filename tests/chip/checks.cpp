// SPDX-License-Identifier: Apache-2.0
// Which chips each suite of checks runs on, in whole telegrams, character by character, bit by bit.
#include "checks.hpp"

#include <string>
#include <vector>

namespace dpchip::checks {
namespace {

std::vector<Case> cases(regmap::VariantSet chips) {
    std::vector<Case> out;
    for (const regmap::Traits& t : regmap::kTraits)
        if (chips.has(t.variant))
            for (const Path path : {Path::telegrams, Path::characters, Path::bits}) out.push_back({t.variant, path});
    return out;
}

regmap::VariantSet without_prm_reserved_checks() {
    regmap::VariantSet set;
    for (const regmap::Traits& t : regmap::kTraits)
        if (!t.prm_reserved_checks)
            set = set | regmap::VariantSet{static_cast<std::uint8_t>(1u << static_cast<unsigned>(t.variant))};
    return set;
}

std::string name(const ::testing::TestParamInfo<Case>& info) {
    std::string out;
    for (const char c : regmap::traits(info.param.variant).name)
        if (c != '+') out += c;
        else out += "plus";
    return out + '_' + std::string{bench::name(info.param.path)};
}

INSTANTIATE_TEST_SUITE_P(Chip, Checks, ::testing::ValuesIn(cases(regmap::kAllVariants)), name);
INSTANTIATE_TEST_SUITE_P(Chip, ChecksVpc3, ::testing::ValuesIn(cases(regmap::kVpc3)), name);
INSTANTIATE_TEST_SUITE_P(Chip, ChecksStepBC, ::testing::ValuesIn(cases(regmap::kStepBC)), name);
INSTANTIATE_TEST_SUITE_P(Chip, ChecksClockSync, ::testing::ValuesIn(cases(regmap::in(regmap::Variant::vpc3c))), name);
INSTANTIATE_TEST_SUITE_P(Chip, ChecksPlainPrm, ::testing::ValuesIn(cases(without_prm_reserved_checks())), name);
INSTANTIATE_TEST_SUITE_P(Chip, ChecksSpc3Class, ::testing::ValuesIn(cases(regmap::kSpc3Class)), name);

}  // namespace
}  // namespace dpchip::checks
