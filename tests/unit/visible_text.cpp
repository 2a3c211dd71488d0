// Text of databases, programs and files moves no cursor and sets no title of a terminal.
#include "sweep/campaign/visible_text.hpp"

#include "sweep/campaign/visible_stream.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace grainsweep::tests::visible_text_test {

TEST(VisibleText, ShowsControlCharactersAndLeavesTheRest) {
    EXPECT_EQ(campaign::visible("plain \xC3\xA9 \xE2\x82\xAC\tand\n"), "plain \xC3\xA9 \xE2\x82\xAC\tand\n");
    EXPECT_EQ(campaign::visible("\x1B]0;title\x07\x1B[2J"), "\\x1b]0;title\\x07\\x1b[2J");
    EXPECT_EQ(campaign::visible(std::string("a\0b\rc\x7F", 6)), "a\\x00b\\x0dc\\x7f");
    EXPECT_EQ(campaign::visible("\xC2\x9B"
                                "31m \xC2\xA0 \xC2"),
              "\\x9b31m \xC2\xA0 \xC2")
        << "C1 in UTF-8, and not beyond";
}

TEST(VisibleText, ReplacesWhatIsNoUtf8) {
    const std::string replaced = "\xEF\xBF\xBD";
    EXPECT_EQ(campaign::valid_utf8("plain \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"),
              "plain \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80");
    EXPECT_EQ(campaign::valid_utf8("a\xFF"), "a" + replaced);
    EXPECT_EQ(campaign::valid_utf8("\xC3"), replaced) << "cut";
    EXPECT_EQ(campaign::valid_utf8("\xC0\xAF"), replaced + replaced) << "longer than need be";
    EXPECT_EQ(campaign::valid_utf8("\xED\xA0\x80"), replaced + replaced + replaced) << "half a surrogate pair";
    EXPECT_EQ(campaign::valid_utf8("\xF4\x90\x80\x80").size(), 4 * replaced.size()) << "beyond U+10FFFF";
}

TEST(VisibleStream, StandsInFrontOfAStreamUntilItGoes) {
    std::ostringstream out;
    {
        const campaign::VisibleStream visible(out);
        out << "a\x1B[2J" << 'b' << '\x07' << '\xC2' << '\x9B' << "\xC2"
            << "\xA0" << 1.5 << std::endl
            << '\xC2';
    }
    EXPECT_EQ(out.str(),
              "a\\x1b[2Jb\\x07\\x9b\xC2\xA0"
              "1.5\n\xC2");
    out << '\x1B';
    EXPECT_TRUE(out.str().ends_with('\x1B'));
}

}  // namespace grainsweep::tests::visible_text_test
