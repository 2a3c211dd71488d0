// Keyed files: whole or absent, whatever happened to them and however many processes write them at once.
#include "sweep/files/artefacts.hpp"
#include "sweep/files/system_error.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace grainsweep::tests::store_artefacts_test {

using files::ArtefactFolder;

Bytes bytes(std::size_t count, unsigned first = 0) {
    Bytes contents(count);
    for (std::size_t k = 0; k < count; ++k) contents[k] = static_cast<std::byte>((first + 31 * k) & 0xffU);
    return contents;
}

struct StoreArtefacts : testing::Test {
    Folder folder;
    std::filesystem::path place = folder.path() / "new" / "artefacts";
    ArtefactFolder artefacts{place};

    std::filesystem::path only_file() const { return std::filesystem::directory_iterator(place)->path(); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(place), std::filesystem::directory_iterator()));
    }
    static std::string read(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void write(const std::filesystem::path& file, std::string_view text) {
        std::ofstream(file, std::ios::binary) << text;
    }
};

TEST_F(StoreArtefacts, WhatIsPutIsGot) {
    EXPECT_FALSE(artefacts.get("packing"));
    for (const std::size_t size : {0u, 1u, 4096u, 100'000u}) {
        artefacts.put("packing", bytes(size));
        EXPECT_EQ(artefacts.get("packing"), bytes(size));
    }
    EXPECT_EQ(ArtefactFolder(place).get("packing"), bytes(100'000)) << "also by another process";
    EXPECT_FALSE(artefacts.get("packing "));
    EXPECT_EQ(files(), 1u) << "nothing is left aside";
    artefacts.remove("packing");
    artefacts.remove("packing");
    EXPECT_FALSE(artefacts.get("packing"));
}

TEST_F(StoreArtefacts, ACutFileIsAbsent) {
    artefacts.put("key", bytes(50));
    const auto whole = read(only_file());
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write(only_file(), whole.substr(0, length));
        EXPECT_FALSE(artefacts.get("key")) << length;
    }
    write(only_file(), whole + "x");
    EXPECT_FALSE(artefacts.get("key"));
    write(only_file(), whole);
    EXPECT_TRUE(artefacts.get("key"));
}

TEST_F(StoreArtefacts, AFlippedBitIsSeen) {
    artefacts.put("key", bytes(50));
    const auto whole = read(only_file());
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const int bit : {0, 7}) {
            auto damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
            write(only_file(), damaged);
            EXPECT_FALSE(artefacts.get("key")) << at;
        }
    }
}

TEST_F(StoreArtefacts, AFileUnderAnotherKeysNameIsAbsent) {
    artefacts.put("one", bytes(10));
    const auto one = only_file();
    const auto contents = read(one);
    artefacts.put("two", bytes(10, 5));
    for (const auto& entry : std::filesystem::directory_iterator(place)) write(entry.path(), contents);
    EXPECT_EQ(artefacts.get("one"), bytes(10));
    EXPECT_FALSE(artefacts.get("two"));
}

TEST_F(StoreArtefacts, ManyWritersLeaveOneWholeFile) {
    constexpr int writers = 4;
    for (int writer = 0; writer < writers; ++writer) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            bool whole = true;
            for (unsigned k = 0; k < 25; ++k) {
                artefacts.put("key", bytes(20'000, k));
                const auto got = artefacts.get("key");
                whole = whole && got && got->size() == 20'000;
            }
            _exit(whole ? 0 : 1);
        }
    }
    for (int writer = 0; writer < writers; ++writer) {
        int status = -1;
        ASSERT_GT(wait(&status), 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_TRUE(artefacts.get("key"));
    EXPECT_EQ(files(), 1u);
}

TEST_F(StoreArtefacts, WhatAKilledWriterLeftIsSweptUpAfterADay) {
    artefacts.put("key", bytes(3));
    write(place / "old.aside", "half");
    write(place / "young.aside", "half");
    std::filesystem::last_write_time(place / "old.aside",
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(48));
    ArtefactFolder(place).put("key", bytes(3));
    EXPECT_FALSE(std::filesystem::exists(place / "old.aside"));
    EXPECT_TRUE(std::filesystem::exists(place / "young.aside"));
}

TEST_F(StoreArtefacts, DamageIsNamed) {
    std::vector<std::string> sentences;
    ArtefactFolder watched(place, [&](const std::string& sentence) { sentences.push_back(sentence); });
    EXPECT_FALSE(watched.get("key"));
    EXPECT_TRUE(sentences.empty()) << "what is not there is not damaged";
    watched.put("key", bytes(50));
    EXPECT_TRUE(watched.get("key"));
    EXPECT_TRUE(sentences.empty());
    const auto whole = read(only_file());
    const auto damaged = [&](const std::string& text) {
        write(only_file(), text);
        EXPECT_FALSE(watched.get("key"));
        const std::string sentence = sentences.empty() ? "" : sentences.back();
        EXPECT_NE(sentence.find(only_file().string()), std::string::npos) << sentence;
        sentences.clear();
        return sentence;
    };
    auto flipped = whole;
    flipped.back() = static_cast<char>(flipped.back() ^ 1);
    EXPECT_NE(damaged(whole.substr(0, 20)).find("is cut short"), std::string::npos);
    EXPECT_NE(damaged(whole.substr(0, 60)).find("its length is not as written"), std::string::npos);
    EXPECT_NE(damaged(std::string(100, 'x')).find("no such file"), std::string::npos);
    EXPECT_NE(damaged(flipped).find("its checksum does not fit"), std::string::npos);
    EXPECT_NE(damaged(flipped).find("computed anew"), std::string::npos);
}

// Opening a named pipe would wait for a writer; a folder has a size, and nothing to read.
TEST_F(StoreArtefacts, WhatIsNoRegularFileIsDamaged) {
    std::vector<std::string> sentences;
    ArtefactFolder watched(place, [&](const std::string& sentence) { sentences.push_back(sentence); });
    watched.put("key", bytes(50));
    const auto file = only_file();
    const auto all = [](std::string_view) { return true; };
    std::filesystem::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_FALSE(watched.get("key"));
    watched.sweep(all);
    watched.put("key", bytes(50));  // takes its place
    EXPECT_EQ(watched.get("key"), bytes(50));
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_FALSE(watched.get("key"));
    watched.sweep(all);
    std::filesystem::remove(file);
    std::filesystem::create_symlink(file.filename(), file);
    EXPECT_FALSE(watched.get("key"));
    ASSERT_EQ(sentences.size(), 3U);
    EXPECT_NE(sentences[0].find("it is no regular file"), std::string::npos);
    EXPECT_NE(sentences[1].find("it is no regular file"), std::string::npos);
}

TEST_F(StoreArtefacts, WhatADeadProcessLeftIsSweptAtOnce) {
    artefacts.put("key", bytes(3));
    std::array<char, 65> host{};
    ASSERT_EQ(gethostname(host.data(), host.size() - 1), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(0);
    siginfo_t ended{};  // and it stays in the list of processes
    ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
    const auto named = [&](const std::string& on, pid_t process) {
        return place / ("." + on + "." + std::to_string(process) + ".0.aside");
    };
    const auto dead = named(host.data(), child), own = named(host.data(), getpid()),
               elsewhere = named("far.away", child), long_ago = named("far.away", 7);
    for (const auto& file : {dead, own, elsewhere, long_ago}) write(file, "half");
    std::filesystem::last_write_time(long_ago,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::minutes(11));
    ArtefactFolder(place).sweep([](std::string_view) { return false; });
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_FALSE(std::filesystem::exists(dead));
    EXPECT_FALSE(std::filesystem::exists(long_ago));
    EXPECT_TRUE(std::filesystem::exists(own));
    EXPECT_TRUE(std::filesystem::exists(elsewhere)) << "another host's may be at work";
    EXPECT_TRUE(artefacts.get("key"));
    ArtefactFolder(folder / "not there").sweep([](std::string_view) { return true; });
}

TEST_F(StoreArtefacts, WhatIsOverIsSweptByItsKey) {
    for (const char* key : {"checkpoint of a", "checkpoint of b", "packing"}) artefacts.put(key, bytes(3));
    write(place / "short.artefact", "gswpart1");
    std::vector<std::string> keys;
    artefacts.sweep([&](std::string_view key) {
        keys.emplace_back(key);
        return key == "checkpoint of a";
    });
    EXPECT_EQ(keys.size(), 3U);
    EXPECT_FALSE(artefacts.get("checkpoint of a"));
    EXPECT_TRUE(artefacts.get("checkpoint of b"));
    EXPECT_TRUE(artefacts.get("packing"));
    EXPECT_EQ(files(), 3U) << "what says of nothing that it is over stays";
}

TEST_F(StoreArtefacts, AFolderThatCannotBeMadeIsABrokenWorld) {
    write(folder / "file", "in the way");
    ArtefactFolder impossible(folder.path() / "file" / "artefacts");
    EXPECT_THROW(impossible.put("key", bytes(3)), SystemError);
    EXPECT_FALSE(impossible.get("key"));
}

}  // namespace grainsweep::tests::store_artefacts_test
