// Words of other programs and of the field lead to the names used here.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/synonyms.hpp"
#include "sweep/designs/design.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainsweep::tests::campaign_synonyms_test {

using campaign::nearest_word;

std::vector<std::string> parameters_of(const char* scene) {
    std::vector<std::string> names;
    for (const auto& parameter : campaign::scene_named(scene)->parameters) names.push_back(parameter.name);
    return names;
}

TEST(Synonyms, OfDesigns) {
    std::vector<std::string> designs;
    for (const auto& design : designs::design_catalogue()) designs.push_back(design.name);
    for (const auto& [word, name] : std::vector<std::pair<std::string, std::string>>{{"lhs", "latin_hypercube"},
                                                                                     {"LHS", "latin_hypercube"},
                                                                                     {"full_factorial", "lattice"},
                                                                                     {"factorial", "lattice"},
                                                                                     {"grid", "lattice"},
                                                                                     {"monte_carlo", "random"},
                                                                                     {"qmc", "halton"},
                                                                                     {"haltn", "halton"}})
        EXPECT_EQ(nearest_word(word, designs), name) << word;
}

TEST(Synonyms, OfParametersWhereTheSceneHasThem) {
    const auto spreading = parameters_of("powder_spreading");
    for (const auto& [word, name] : std::vector<std::pair<std::string, std::string>>{{"mu", "friction"},
                                                                                     {"E", "youngs_modulus"},
                                                                                     {"e", "restitution"},
                                                                                     {"rho", "density"},
                                                                                     {"d", "diameter"},
                                                                                     {"nu", "poisson_ratio"},
                                                                                     {"g", "gravity"},
                                                                                     {"velocity", "speed"},
                                                                                     {"frction", "friction"}})
        EXPECT_EQ(nearest_word(word, spreading), name) << word;
    EXPECT_EQ(nearest_word("Ra", parameters_of("thermovibration")), "rayleigh");
    EXPECT_EQ(nearest_word("Ra", spreading), "") << "a name that the scene lacks is no suggestion";
    EXPECT_EQ(nearest_word("rho", parameters_of("rehearsal")), "");
}

TEST(Synonyms, AWordThatOnlyOneNameHasBetweenItsUnderscoresIsThatName) {
    const std::vector<std::string> scenes = {"powder_spreading", "tpms_discharge", "rehearsal"};
    EXPECT_EQ(nearest_word("spreading", scenes), "powder_spreading");
    EXPECT_EQ(nearest_word("tpms", scenes), "tpms_discharge");
    EXPECT_EQ(nearest_word("spread", scenes), "");
    const std::vector<std::string> flows = {"mfr_window", "mfr_thesis"};
    EXPECT_EQ(nearest_word("mfr", flows), "") << "two have it";
}

TEST(Synonyms, OfKeysShowHowTheKeyIsUsed) {
    std::vector<std::string> keys;
    for (const auto& key : campaign::factor_keys) keys.emplace_back(key.name);
    for (const char* word : {"min", "max", "low", "high", "range"})
        EXPECT_EQ(nearest_word(word, keys), "\"between\": [low, high]") << word;
    EXPECT_EQ(nearest_word("values", keys), "\"levels\": [...]");
}

TEST(Synonyms, OfOptions) {
    const std::vector<std::string> options = {"--db", "-j", "-k", "--again", "--format"};
    EXPECT_EQ(nearest_word("--jobs", options), "-j");
    EXPECT_EQ(nearest_word("--workers", options), "-j");
    EXPECT_EQ(nearest_word("--json", options), "--format json");
    EXPECT_EQ(nearest_word("--jobs", std::vector<std::string>{"--db"}), "");
}

}  // namespace grainsweep::tests::campaign_synonyms_test
