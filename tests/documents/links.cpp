// What the documents point to is there, and what must be pointed to is.
#include "tests/documents/page.hpp"
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace grainsweep::tests::links_test {

namespace fs = std::filesystem;

TEST(Documents, EveryLinkLeadsSomewhere) {
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    std::size_t links = 0;
    for (const auto& page : all_pages()) {
        for (const auto& [number, line] : page.prose()) {
            for (std::sregex_iterator it(line.begin(), line.end(), link), end; it != end; ++it) {
                const std::string target = (*it)[1];
                if (target.find("://") != std::string::npos || target.starts_with("mailto:")) continue;
                ++links;
                const auto hash = target.find('#');
                const fs::path file = target.substr(0, hash);
                const fs::path there = file.empty() ? page.file : (page.file.parent_path() / file).lexically_normal();
                EXPECT_TRUE(fs::exists(source() / there)) << page.file << ":" << number << " " << target;
                if (hash == std::string::npos || there.extension() != ".md") continue;
                const auto anchors = read_page(there).anchors();
                EXPECT_NE(std::ranges::find(anchors, target.substr(hash + 1)), anchors.end())
                    << page.file << ":" << number << " " << target << ": no such heading";
            }
        }
    }
    EXPECT_GT(links, 20U);
}

TEST(Documents, EveryPageIsReachedFromTheReadme) {
    static const std::regex link(R"(\]\(([^)#\s]+)[^)]*\))");
    std::set<fs::path> reached = {"README.md"};
    std::vector<fs::path> open = {"README.md"};
    while (!open.empty()) {
        const auto page = read_page(open.back());
        open.pop_back();
        for (std::sregex_iterator it(page.text.begin(), page.text.end(), link), end; it != end; ++it) {
            const fs::path there = (page.file.parent_path() / (*it)[1].str()).lexically_normal();
            if (there.extension() == ".md" && fs::exists(source() / there) && reached.insert(there).second)
                open.push_back(there);
        }
    }
    for (const auto& page : user_pages()) EXPECT_TRUE(reached.contains(page.file)) << page.file;
}

TEST(Documents, EveryPageStandsInTheSite) {
    std::ifstream stream(source("docs/mkdocs.yml"));
    const std::string site{std::istreambuf_iterator<char>(stream), {}};
    for (const auto& page : user_pages())
        EXPECT_NE(site.find("- " + page.file.string() + "\n"), std::string::npos) << page.file;
    static const std::regex entry("\n +- (\\S+)(?=\n)");
    std::set<std::string> listed;
    for (std::sregex_iterator it(site.begin(), site.end(), entry), end; it != end; ++it) {
        const std::string page = (*it)[1];
        if (!page.ends_with(".md")) continue;
        EXPECT_TRUE(fs::exists(source(page))) << "docs/mkdocs.yml lists " << page;
        EXPECT_TRUE(listed.insert(page).second) << "docs/mkdocs.yml lists twice " << page;
    }
    EXPECT_GT(listed.size(), 20U);
}

TEST(Documents, EveryCampaignFileIsMentioned) {
    static const std::regex word("\\w+");
    std::set<std::string> words;
    for (const auto& page : user_pages())
        for (std::sregex_iterator it(page.text.begin(), page.text.end(), word), end; it != end; ++it)
            words.insert(it->str());
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(source("configs"))) {
        if (entry.path().extension() != ".json") continue;
        ++files;
        EXPECT_TRUE(words.contains(entry.path().stem().string())) << entry.path().filename();
    }
    EXPECT_GT(files, 10U);
}

TEST(Documents, EveryCampaignFileMentionedExists) {
    static const std::regex name(R"(\bconfigs/[A-Za-z0-9_.]+\.json)");
    for (const auto& page : user_pages())
        for (std::sregex_iterator it(page.text.begin(), page.text.end(), name), end; it != end; ++it)
            EXPECT_TRUE(fs::exists(source() / it->str())) << page.file << " " << it->str();
}

TEST(Documents, TheReadmeIsShort) {
    const auto text = read_page("README.md").text;
    EXPECT_LE(std::ranges::count(text, '\n'), 150);
}

TEST(Documents, PicturesAreSmall) {
    for (const auto& entry : fs::recursive_directory_iterator(source("docs")))
        if (entry.is_regular_file() && entry.path().extension() != ".md") {
            EXPECT_LT(entry.file_size(), 150'000U) << entry.path();
        }
}

TEST(Documents, SayThingsInTheFieldsTerms) {
    static const std::regex word(R"(\b(nobody|whoever|himself|asleep|sleepers?|TODO|FIXME)\b)");
    for (const auto& page : all_pages()) {
        if (page.file.string().starts_with("tests/")) continue;
        for (const auto& [number, line] : page.prose()) {
            std::smatch match;
            EXPECT_FALSE(std::regex_search(line, match, word)) << page.file << ":" << number << " " << match[0];
        }
    }
}

}  // namespace grainsweep::tests::links_test
