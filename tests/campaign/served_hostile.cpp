// `grainsweep serve` against clients that mean no good: what they get, and that everybody else is served beside them.
#include "tests/support/live_server.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::served_hostile_test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// Texts of a campaign that would be a script where they got out of their place.
const char* config = R"({"campaign": "a", "scene": "rehearsal",
 "notes": "</script><script>window.intruder = 1</script><img src=x onerror=alert(1)>",
 "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 4}})";

struct ServedToEnemies : testing::Test {
    Folder folder;
    std::unique_ptr<LiveServer> server;

    ServedToEnemies() {
        folder.write("a.json", config);
        const auto ended = run_program({"run", "a.json", "--quiet", "-j", "1"}, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        server = std::make_unique<LiveServer>(folder, "a.db");
    }
    [[nodiscard]] HttpSeen raw(std::string_view bytes) const {
        const Connected client(server->port());
        client.send(bytes);
        return client.answer();
    }
    void expect_served() const { EXPECT_EQ(server->get("/").status, 200); }
    [[nodiscard]] Json asked(std::string_view sql) const {
        const auto seen = server->work("/query", "", sql);
        return seen.status == 200 ? Json::parse(seen.body) : Json{{"code", seen.status}, {"err", seen.body}};
    }
};

TEST_F(ServedToEnemies, OtherNamesOriginsAndWordsAreRefused) {
    const auto good = server->request("GET", "/", "");
    EXPECT_EQ(raw(good).status, 200);
    const auto with = [&](const std::string& from, const std::string& to) {
        auto text = good;
        text.replace(text.find(from), from.size(), to);
        return raw(text).status;
    };
    EXPECT_EQ(with("token=" + server->token(), "token=" + std::string(32, '0')), 403);
    EXPECT_EQ(with("token=" + server->token(), ""), 403);
    EXPECT_EQ(with("Host: 127.0.0.1", "Host: evil.example"), 403);
    EXPECT_NE(with("Host: 127.0.0.1:" + std::to_string(server->port()) + "\r\n", ""), 200);
    EXPECT_EQ(raw(server->request("POST", "/query", "", "SELECT 1", "Origin: http://evil.example\r\n")).status, 403);
    EXPECT_EQ(raw(server->request("POST", "/stop", "")).status, 403);
    EXPECT_EQ(raw(server->request("PUT", "/query", "")).status, 405);
    EXPECT_EQ(raw(server->request("OPTIONS", "/query", "")).status, 405) << "no cross-origin request is prepared";
    const auto seen = raw(good);
    EXPECT_EQ(seen.head.find("Access-Control"), std::string::npos);
    for (const auto* line : {"X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer", "X-Frame-Options: DENY",
                             "Content-Security-Policy: default-src 'none'", "Cache-Control: no-store"})
        EXPECT_NE(seen.head.find(line), std::string::npos) << line << '\n' << seen.head;
    EXPECT_EQ(seen.head.find("unsafe-eval"), std::string::npos);
}

TEST_F(ServedToEnemies, BytesThatAreNoRequestHarmNobody) {
    const Connected first(server->port()), second(server->port());  // what is no whole request gets no answer
    first.send(std::string("\0\1\2", 3));
    second.send(std::string(100000, 'A'));
    expect_served();
    for (const auto& bytes : {std::string("GET / HTTP/9.9\r\n\r\n"),
                              "GET /" + std::string(100000, 'a') + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
                              server->request("GET", "/../../etc/passwd", ""),
                              server->request("GET", "/", "", "", "X: " + std::string(100000, 'x') + "\r\n")}) {
        EXPECT_NE(raw(bytes).status, 200) << bytes.substr(0, 60);
        expect_served();
    }
    EXPECT_EQ(raw(server->request("POST", "/query", "", std::string(70000, ' '))).status, 413);
    EXPECT_EQ(raw(server->request("POST", "/query", "", "")).status, 400);
}

TEST_F(ServedToEnemies, NamesLeadNowhereElse) {
    fs::create_directory(folder / "a.films");
    std::ofstream(folder / "secret.html") << "<!doctype html>secret";
    for (const auto* id : {"../secret", "..%2Fsecret", "%2e%2e%2fsecret", "secret", ""})
        EXPECT_EQ(server->get("/film", std::string("case=") + id).status, 404) << id;
    for (const auto* name : {"../a.db", "%2Fetc%2Fpasswd", "secret.html", "a.db%00", "."})
        EXPECT_EQ(server->post("/query", std::string("database=") + name, "SELECT 1").status,
                  std::string(name) == "a.db%00" ? 200 : 404)
            << name;
}

TEST_F(ServedToEnemies, SqlReadsThisDatabaseForAWhileAndNothingElse) {
    EXPECT_EQ(asked("SELECT count(*) AS n FROM a")["code"], 0);
    EXPECT_EQ(asked("-- a comment first\nSELECT 1")["code"], 0);
    for (const auto* sql :
         {"DELETE FROM sim_case", "DROP TABLE attempt", "ATTACH '/etc/passwd' AS p", "PRAGMA journal_mode=DELETE",
          "SELECT 1; DELETE FROM sim_case", "SELECT load_extension('x')", "SELECT readfile('/etc/passwd')",
          "VACUUM INTO '/tmp/copy.db'", "--help", "--output=x", "-h", "nonsense", ";", "\"\"\"", "SELECT ?1"}) {
        const auto seen = asked(sql);
        EXPECT_EQ(seen["code"], 2) << sql << seen;
        EXPECT_NE(seen["err"].get<std::string>().find("grainsweep: "), std::string::npos) << sql;
    }
    EXPECT_EQ(asked("SELECT count(*) AS n FROM sim_case")["out"], asked("SELECT 4 AS n")["out"]);
}

// Its limit is ten seconds of processor time; others are answered beside it, and the server takes it along.
TEST_F(ServedToEnemies, SqlThatNeverEndsKeepsNobodyOut) {
    const char* endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n";
    EXPECT_EQ(server->post("/query", "", endless).status, 200);
    EXPECT_EQ(asked("SELECT 1")["code"], 0);
    EXPECT_FALSE(processes_with("RECURSIVE").empty());
    expect_served();
    server->process().signal(SIGINT);
    EXPECT_EQ(server->process().wait().code, 0);
    for (int tries = 0; tries < 500 && !processes_with("RECURSIVE").empty(); ++tries) std::this_thread::sleep_for(10ms);
    EXPECT_TRUE(processes_with("RECURSIVE").empty());
}

TEST_F(ServedToEnemies, QuestionsThatNobodyFetchesKeepNobodyOut) {
    for (int k = 0; k < 60; ++k) {
        const auto status = server->post("/query", "", "SELECT 1").status;
        EXPECT_TRUE(status == 200 || status == 503) << status;
    }
    int tries = 0;
    for (; asked("SELECT 1")["code"] == 503 && tries < 500; ++tries) std::this_thread::sleep_for(10ms);
    EXPECT_LT(tries, 500);
}

TEST_F(ServedToEnemies, ManyConnectionsHalfRequestsAndReadersThatDoNotReadEnd) {
    std::vector<Connected> readers, silent;
    for (int k = 0; k < 20; ++k) readers.push_back(server->events());  // none of them ever reads
    for (int k = 0; k < 1000; ++k) {
        silent.emplace_back(server->port());
        silent.back().send(k % 2 == 0 ? "GET / HTTP/1.1\r\nHo" : "");
    }
    silent.clear();
    expect_served();
    std::vector<Connected> bodies;
    for (int k = 0; k < 50; ++k) {
        bodies.emplace_back(server->port());
        bodies.back().send(server->request("POST", "/query", "", "", "").substr(0, 60));
    }
    expect_served();
    server->process().signal(SIGINT);
    const auto start = Clock::now();
    EXPECT_EQ(server->process().wait().code, 0);
    EXPECT_LT(Clock::now() - start, 5s);
}

// A page of a stranger lies where films were once kept: a script there would have the token and every database.
TEST_F(ServedToEnemies, FilmsOfAStrangersFolderAreNotServed) {
    const auto id = std::string(32, '0');
    fs::create_directory(folder / "a.films");
    std::ofstream(folder / ("a.films/" + id + ".html")) << "<script>alert(1)</script>";
    EXPECT_EQ(server->get("/film", "case=" + id).status, 404);
    const auto made = Json::parse(server->work("/film", "case=" + id).body);
    EXPECT_EQ(made["code"], 2) << "it is not there already: " << made;
    EXPECT_EQ(server->get("/film", "case=" + id).status, 404);
    for (const auto* ticket : {"", "0", "../../../etc/passwd"}) {
        const auto seen = server->get("/film", std::string("ticket=") + ticket);
        EXPECT_EQ(seen.status, 404) << ticket;
    }
}

// They send a byte now and then: a request that is never whole.
TEST_F(ServedToEnemies, SlowConnectionsKeepNobodyOut) {
    std::vector<Connected> slow;
    for (int k = 0; k < 300; ++k) {
        slow.emplace_back(server->port());
        if (slow.back().is_open()) slow.back().send("GET / HTTP/1.1\r\nX: ");
    }
    const auto stream = server->events();
    for (int k = 0; k < 4; ++k) {
        expect_served();
        for (const auto& one : slow)
            if (one.is_open()) (void)one.send("a");
        std::this_thread::sleep_for(300ms);
    }
}

TEST_F(ServedToEnemies, TheTokenStandsInNoArgumentOfABrowser) {
    folder.write("xdg-open", "#!/bin/sh\necho \"$@\" > opened; cp \"$1\" page\n");
    fs::permissions(folder / "xdg-open", fs::perms::owner_all);
    const auto path = folder.path().string() + ":" + std::getenv("PATH");
    Process opens({"/usr/bin/env", "PATH=" + path, program_command({})[0], "serve", "a.db", "--port", "0", "--open"},
                  folder.path());
    for (int k = 0; k < 1000 && !fs::exists(folder / "page"); ++k) std::this_thread::sleep_for(10ms);
    std::ifstream given(folder / "opened"), page(folder / "page");
    const std::string words{std::istreambuf_iterator<char>(given), {}}, text{std::istreambuf_iterator<char>(page), {}};
    EXPECT_EQ(words.find("token"), std::string::npos) << words;
    EXPECT_NE(text.find("?token="), std::string::npos) << text;
    opens.signal(SIGINT);
    EXPECT_EQ(opens.wait().code, 0);
    EXPECT_FALSE(fs::exists(words.substr(0, words.find('\n')))) << "it is removed";
}

TEST_F(ServedToEnemies, TextsOfTheCampaignStayTexts) {
    const auto page = server->get("/").body;
    EXPECT_EQ(page.find("<script>window.intruder"), std::string::npos);
    EXPECT_EQ(page.find("<img"), std::string::npos);
    const auto data = server->get("/data");
    EXPECT_NE(data.head.find("Content-Type: application/json"), std::string::npos);
    EXPECT_NE(Json::parse(data.body)["campaigns"][0]["notes"].get<std::string>().find("<script>"), std::string::npos)
        << "and come whole";
}

}  // namespace grainsweep::tests::served_hostile_test
