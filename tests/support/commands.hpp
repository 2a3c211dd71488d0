// A folder in which tests give commands to the program.
#pragma once

#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainsweep::tests {

struct CommandsInAFolder : testing::Test {
    Folder folder;

    [[nodiscard]] Ended ask(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    /// What a command writes that must succeed.
    std::string out(const std::vector<std::string>& arguments) const {
        const auto ended = ask(arguments);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended.out;
    }
};

}  // namespace grainsweep::tests
