#include "tests/support/wrong_machines.hpp"

#include "sweep/campaign/input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

using nlohmann::json;

/// Files that wrong machines name.
const FileTexts& wrong_files() {
    static const FileTexts files = {{"sizes.csv", "diameter,mass\n"},
                                    {"fine.csv", "diameter,number_below\n0.0001,0\n0.0002,1\n"},
                                    {"bad.stl", "x"},
                                    {"s.csv", "x,y\n1,2\n"},
                                    {"t.csv", "x,y,z\n0.01,0.01,b\n"},
                                    {"u.csv", "x,y,z,diameter\n0.01,0.01,0.01,-1\n"},
                                    {"v.csv", "x,y,z,colour\n1,2,3,4\n"}};
    return files;
}

}  // namespace

std::string refusal_of(const json& document, const Inputs& chosen) {
    try {
        machine::Run run(spec_of(document, chosen, wrong_files()), 1);
    } catch (const campaign::InputError& wrong) {
        return wrong.what();
    } catch (const std::invalid_argument& wrong) {
        return wrong.what();
    }
    return "accepted";
}

void expect_refusal(const WrongMachine& wrong) {
    const std::string path = wrong.path, value = wrong.value;
    json patch = json::array();
    if (path == "PATCH")
        patch = json::parse(value);
    else if (value == "REMOVE")
        patch.push_back({{"op", "remove"}, {"path", path}});
    else
        patch.push_back({{"op", "add"}, {"path", path}, {"value", json::parse(value)}});
    const std::string sentence = refusal_of(small_machine().patch(patch));
    EXPECT_TRUE(sentence.starts_with(wrong.place)) << path << " " << value << "\n" << sentence;
    EXPECT_NE(sentence.find(wrong.rule), std::string::npos) << path << " " << value << "\n" << sentence;
    EXPECT_EQ(std::ranges::count(sentence, '\n'), 0) << sentence;
}

}  // namespace grainsweep::tests
