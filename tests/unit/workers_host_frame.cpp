// Frames between main program and host: whatever pieces they come in, they are the same, and what is none is noticed.
#include "sweep/workers/host_frame.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainsweep::tests::workers_host_frame_test {

using namespace workers::frames;

std::string shown(const Frame& frame) {
    struct Show {
        std::string operator()(const Hello& f) const { return "hello " + std::to_string(f.protocol); }
        std::string operator()(const Start& f) const { return "start " + std::to_string(f.worker); }
        std::string operator()(const Piece& f) const {
            return std::to_string(f.worker) + " says " + std::string(f.bytes);
        }
        std::string operator()(const Signal& f) const {
            return "signal " + std::to_string(f.worker) + " " + std::to_string(f.number);
        }
        std::string operator()(const Close& f) const { return "close " + std::to_string(f.worker); }
        std::string operator()(const workers::frames::Ended& f) const {
            return "ended " + std::to_string(f.worker) + " " + std::to_string(f.status) + " " + std::string(f.log);
        }
        std::string operator()(const Beat&) const { return "beat"; }
        std::string operator()(const Greeting& f) const { return "greeting " + std::string(f.line); }
    };
    return std::visit(Show{}, frame);
}

/// What a reader makes of the text, given in pieces of at most `length` bytes; "nonsense" where it gave up.
std::vector<std::string> read_in_pieces(Reader::Side side, std::string_view text, std::size_t length) {
    Reader reader(side);
    std::vector<std::string> frames;
    while (!text.empty()) {
        const auto piece = text.substr(0, length);
        text.remove_prefix(piece.size());
        if (!reader.feed(piece, [&](const Frame& frame) { frames.push_back(shown(frame)); })) {
            frames.emplace_back("nonsense");
            break;
        }
    }
    return frames;
}

TEST(HostFrames, AreTheSameInPiecesOfAnyLength) {
    std::string text = "welcome to node 7\nsecond line\n";
    add_hello(text);
    add_piece(text, 7, "{\"ready\":{}}\n");
    add_piece(text, 12, "half a li");
    text += alive_frame;
    add_piece(text, 12, "ne\n\n5 5\n");
    add_ended(text, 7, 9, "two\nlines");
    add_ended(text, 12, 0, "");
    const std::vector<std::string> expected = {"greeting welcome to node 7", "greeting second line", "hello 2",
                                               "7 says {\"ready\":{}}\n",    "12 says half a li",    "beat",
                                               "12 says ne\n\n5 5\n",        "ended 7 9 two\nlines", "ended 12 0 "};
    for (std::size_t length = 1; length <= text.size(); ++length)
        EXPECT_EQ(read_in_pieces(Reader::Side::main_program, text, length), expected) << length;
}

TEST(HostFrames, OfTheMainProgram) {
    std::string text;
    add_start(text, 1);
    add_piece(text, 1, std::string(1000, 'x'));
    add_signal(text, 1, 15);
    add_close(text, 1);
    text += lease_frame;
    const std::vector<std::string> expected = {"start 1", "1 says " + std::string(1000, 'x'), "signal 1 15", "close 1",
                                               "beat"};
    for (const std::size_t length : {1U, 2U, 7U, 64U, 5000U})
        EXPECT_EQ(read_in_pieces(Reader::Side::host, text, length), expected) << length;
}

TEST(HostFrames, ALongPieceTravelsInSeveral) {
    const std::string bytes(3 * longest_piece + 17, 'y');
    std::string text;
    add_piece(text, 3, bytes);
    Reader reader(Reader::Side::host);
    std::string joined;
    int pieces = 0;
    EXPECT_TRUE(reader.feed(text, [&](const Frame& frame) {
        joined += std::get<Piece>(frame).bytes;
        ++pieces;
    }));
    EXPECT_EQ(pieces, 4);
    EXPECT_EQ(joined, bytes);
}

TEST(HostFrames, WhatIsNoneIsNoticed) {
    for (const std::string text : {"nonsense\n",
                                   "\n",
                                   "7\n",
                                   "7 x 1\n",
                                   "7 5 5 1\n",
                                   "-7 5 1\n",
                                   "7 -5 1\n",
                                   "7 5 x\n",
                                   "7 65537 1\n",
                                   "7 5 4294967296\n",
                                   "7 5 1\nabcdefgh",
                                   "7 3 1\nabc\n",
                                   "start\n",
                                   "start 1\n",
                                   "start x 1\n",
                                   "start 1 2 3\n",
                                   "signal 1 15\n",
                                   "alive 1\n",
                                   "ended 1 2 0\n",
                                   "ended 1 2 99999999 1\n",
                                   "99999999999999999999999 1 1\n"}) {
        const auto frames = read_in_pieces(Reader::Side::host, text, 3);
        EXPECT_EQ(frames, std::vector<std::string>{"nonsense"}) << text;
    }
}

// printf '7 14\n{"y":3.141592}' | cksum, printf 'start 7\n' | cksum
TEST(HostFrames, TheirSumIsThatOfCksum) {
    std::string text;
    add_piece(text, 7, "{\"y\":3.141592}");
    EXPECT_EQ(text, "7 14 3960313895\n{\"y\":3.141592}\n");
    text.clear();
    add_start(text, 7);
    EXPECT_EQ(text, "start 7 3397496786\n");
}

TEST(HostFrames, AChangedBitIsNoticed) {
    std::string text;
    add_hello(text);
    add_piece(text, 12, "{\"done\":{\"y\":0.25}}\n");
    add_ended(text, 7, 9, "a log");
    const std::vector<std::string> written = {"hello 2", "12 says {\"done\":{\"y\":0.25}}\n", "ended 7 9 a log"};
    ASSERT_EQ(read_in_pieces(Reader::Side::main_program, text, text.size()), written);
    const std::size_t begin = text.find('\n') + 1;  // a changed first line is a launcher's
    for (std::size_t at = begin; at < text.size(); ++at)
        for (int bit = 0; bit < 8; ++bit) {
            std::string changed = text;
            changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
            const auto frames = read_in_pieces(Reader::Side::main_program, changed, changed.size());
            EXPECT_TRUE(frames.back() == "nonsense" || frames.size() < written.size()) << at << ", bit " << bit;
        }
}

TEST(HostFrames, NothingGrowsWithoutBound) {
    EXPECT_EQ(read_in_pieces(Reader::Side::host, std::string(1000, '1'), 10), std::vector<std::string>{"nonsense"});
    EXPECT_EQ(read_in_pieces(Reader::Side::main_program, std::string(100'000, 'x'), 1000),
              std::vector<std::string>{"nonsense"});
    std::string greetings;
    for (int line = 0; line < 10'000; ++line) greetings += "a greeting that does not end\n";
    EXPECT_EQ(read_in_pieces(Reader::Side::main_program, greetings, 4096).back(), "nonsense");
}

}  // namespace grainsweep::tests::workers_host_frame_test
