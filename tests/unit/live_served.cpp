// Access rules of the server of running campaigns, and the events that readers get.
#include "sweep/live/served.hpp"
#include "tests/support/archive.hpp"
#include "tests/support/written.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace grainsweep::tests::live_served_test {

using namespace live;
using Json = nlohmann::ordered_json;
using store::Store;

const std::string token = "0123456789abcdef0123456789abcdef";
const std::string here_host = "127.0.0.1:8377";

struct LiveServed : testing::Test {
    Folder folder;
    campaign::Campaign asked = small_campaign("first");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 40);
    Store store{folder / "a.db", Store::Mode::create};
    std::optional<Served> served;

    LiveServed() {
        (void)store.enrol(asked, cases, here());
        serve(std::nullopt);
    }
    void serve(std::optional<Control> control) {
        served.emplace(std::vector{folder / "a.db"}, std::move(control), token);
    }

    static HttpQuestion get(const std::string& path) {
        HttpQuestion question;
        question.method = "GET";
        question.path = path;
        question.query.emplace("token", token);
        question.host = here_host;
        return question;
    }
    static HttpQuestion post(const std::string& path) {
        auto question = get(path);
        question.method = "POST";
        return question;
    }
    HttpAnswer answered(const HttpQuestion& question) { return std::get<HttpAnswer>(served->answer(question)); }
    unsigned status(const HttpQuestion& question) { return answered(question).status; }
    /// What a stream that opens now begins with.
    std::string opened(const std::string& since) {
        auto question = get("/events");
        question.query.insert_or_assign("since", since);
        return std::get<HttpStream>(served->answer(question)).first;
    }
    /// The events until some contain the text.
    std::string awaited(std::string_view text) {
        const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        std::string events;
        while (events.find(text) == std::string::npos && std::chrono::steady_clock::now() < last) {
            events += served->look();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return events;
    }
};

TEST_F(LiveServed, NothingIsAnsweredWithoutTheToken) {
    for (const auto* path : {"/", "/data", "/events", "/job", "/film", "/query", "/stop", "/nothing"})
        for (const auto* word : {"", "0", "0123456789abcdef0123456789abcdeg", "0123456789abcdef0123456789abcdef0"})
            for (auto question : {get(path), post(path)}) {
                question.query["token"] = word;
                EXPECT_EQ(status(question), 403u) << path << ' ' << word;
            }
    EXPECT_EQ(status(get("/")), 200u);
}

// A page of another site may make its own name point here: its Host field gives it away.
TEST_F(LiveServed, NothingIsAnsweredUnderAForeignName) {
    for (const auto* host :
         {"", "evil.example", "evil.example:8377", "127.0.0.1.evil.example", "localhost.evil.example", "127.0.0.2",
          "[::1", "[::2]:8377", "0.0.0.0:8377", "evil.example:127.0.0.1"}) {
        auto question = get("/");
        question.host = host;
        EXPECT_EQ(status(question), 403u) << host;
    }
    for (const auto* host : {"127.0.0.1", "localhost", "localhost:9000", "[::1]:8377"}) {
        auto question = get("/");
        question.host = host;
        EXPECT_EQ(status(question), 200u) << host;
    }
}

TEST_F(LiveServed, APageOfAnotherOriginMayAskForNothing) {
    for (const auto* origin : {"http://evil.example", "null", "https://127.0.0.1:8377", "http://127.0.0.1:9000"})
        for (const auto* path : {"/query", "/film", "/stop", "/run", "/again"}) {
            auto question = post(path);
            question.origin = origin;
            question.body = "SELECT 1";
            EXPECT_EQ(status(question), 403u) << origin << ' ' << path;
        }
    auto own = post("/query");
    own.origin = "http://" + here_host;
    EXPECT_EQ(status(own), 400u) << "an empty question, but of the page itself";
}

// Behind a proxy of a notebook or a cluster, the server accepts the name, path and scheme of this proxy only.
TEST_F(LiveServed, AnswersBehindTheProxyThatTheUserNames) {
    served.emplace(std::vector{folder / "a.db"}, std::nullopt, token,
                   Proxy{.base_path = "/node/n7/8377/", .hosts = {"hub.example.org"}});
    for (const auto* path : {"/node/n7/8377/", "/", "/node/n7/8377/data", "/data"}) {
        for (const auto* host : {"hub.example.org", "hub.example.org:443", "127.0.0.1:8377"}) {
            auto question = get(path);
            question.host = host;
            EXPECT_EQ(status(question), 200u) << path << ' ' << host;
        }
    }
    auto question = get("/");
    question.host = "evil.example.org";
    EXPECT_EQ(status(question), 403u);
    EXPECT_EQ(status(get("/node/n8/8377/data")), 404u);
    for (const auto& [origin, wanted] : {std::pair{"https://hub.example.org", 400u},
                                         {"http://hub.example.org:80", 400u},
                                         {"https://evil.example.org", 403u},
                                         {"https://hub.example.org.evil", 403u}}) {
        auto query = post("/node/n7/8377/query");
        query.origin = origin;
        EXPECT_EQ(status(query), wanted) << origin;
    }
}

// A tab that was reloaded has no token in its address. The script of the refusal finds the one that the tab has kept.
TEST_F(LiveServed, APageWithoutTokenLeadsATabBackThatHasOne) {
    auto question = get("/");
    question.query.clear();
    const auto seen = answered(question);
    EXPECT_EQ(seen.status, 403u);
    EXPECT_NE(seen.body->find("sessionStorage"), std::string::npos);
    EXPECT_EQ(seen.body->find(token), std::string::npos);
    EXPECT_NE(seen.policy.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
}

TEST_F(LiveServed, AReaderWithoutAStreamGetsTheSameEvents) {
    settle(store, cases[1].question, 1);
    (void)awaited("event: results");
    auto question = get("/events");
    question.query.insert_or_assign("since", "x");
    const auto stream = opened("x");
    question.query.emplace("once", "1");
    const auto seen = answered(question);
    EXPECT_EQ(seen.type, "text/event-stream");
    EXPECT_EQ(*seen.body, stream);
}

TEST_F(LiveServed, OddQuestionsGetASentence) {
    EXPECT_EQ(status(get("/../a.db")), 404u);
    EXPECT_EQ(status(get("/query")), 404u) << "SQL is posted";
    auto head = get("/");
    head.method = "DELETE";
    EXPECT_EQ(status(head), 405u);
    for (const auto* id : {"", "../../a.db", "..%2f", "0123456789ABCDEF0123456789ABCDEF", "0123"}) {
        auto film = get("/film");
        film.query["case"] = id;
        EXPECT_EQ(status(film), 404u) << id;
        film.method = "POST";
        EXPECT_EQ(status(film), 404u) << id;
    }
    for (const auto* name : {"../a.db", "/etc/passwd", "b.db"}) {
        auto query = post("/query");
        query.body = "SELECT 1";
        query.query["database"] = name;
        EXPECT_EQ(status(query), 404u) << name;
    }
    auto large = post("/query");
    large.too_large = true;
    EXPECT_EQ(status(large), 413u);
    auto job = get("/job");
    for (const auto* number : {"", "-1", "7", "x", "99999999999999999999"}) {
        job.query["number"] = number;
        EXPECT_EQ(status(job), 404u) << number;
    }
}

TEST_F(LiveServed, AReaderGetsResultsAndOneThatWasAwayGetsThoseItMissed) {
    settle(store, cases[1].question, 1);
    auto first = awaited("event: results");
    EXPECT_NE(first.find(cases[1].question.id), std::string::npos);
    const auto begin = first.find("id: ", first.rfind("\n\n", first.find("event: results")) + 1) + 4;
    const auto seen = first.substr(begin, first.find('\n', begin) - begin);
    settle(store, cases[2].question, 1);
    (void)awaited("event: results");
    const auto missed = opened(seen);
    EXPECT_EQ(missed.find(cases[1].question.id), std::string::npos) << "it saw this one";
    EXPECT_NE(missed.find(cases[2].question.id), std::string::npos);
    EXPECT_EQ(missed.find("event: page"), std::string::npos) << "nothing else is to be asked";
    EXPECT_NE(missed.find("event: now"), std::string::npos);
}

TEST_F(LiveServed, AReaderOfAnotherServerIsToldToAskEverythingAnew) {
    settle(store, cases[1].question, 1);
    (void)awaited("event: results");
    for (const auto* since : {"", "x", "deadbeef-0", "-5"})
        EXPECT_NE(opened(since).find("event: page"), std::string::npos) << since;
}

TEST_F(LiveServed, TheDataOfThePageFollow) {
    const auto rows = [&] {
        return Json::parse(*answered(get("/data")).body)["campaigns"][0]["observables"][0]["history"];
    };
    const auto before = rows();
    settle(store, cases[0].question, 1);
    const auto events = awaited("event: page");
    EXPECT_NE(events.find("event: page"), std::string::npos);
    EXPECT_NE(rows(), before);
}

TEST_F(LiveServed, NobodySteersWithoutControl) {
    for (const auto* path : {"/stop", "/run", "/again", "/more"}) EXPECT_EQ(status(post(path)), 403u) << path;
}

// The file that says which process to stop may be written by anybody who may write into the folder.
TEST_F(LiveServed, StopsNoProcessThatDoesNotHoldTheDatabase) {
    serve(Control{{folder / "c.json"}});
    EXPECT_EQ(status(post("/stop")), 409u) << "nothing runs";
    char host[65] = {};
    ::gethostname(host, sizeof host - 1);
    for (const std::int64_t process : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, std::int64_t{::getppid()}}) {
        Now now;
        now.campaign = "first";
        now.host = host;
        now.process = process;
        write_now(now_file(folder / "a.db"), now);
        EXPECT_EQ(status(post("/stop")), 409u) << process;
    }
    EXPECT_EQ(status(post("/run")), 409u) << "while a run says it is there";
}

TEST_F(LiveServed, OfSeveralCampaignFilesTheReaderNamesOne) {
    serve(Control{{folder / "b.json", folder / "c.json"}});
    EXPECT_NE(answered(get("/")).body->find(R"("steerable":["b.json","c.json"])"), std::string::npos);
    EXPECT_EQ(status(post("/run")), 404u) << "which?";
    auto strange = post("/run");
    strange.query.emplace("config", "../c.json");
    EXPECT_EQ(status(strange), 404u);
    auto stop = post("/stop");
    stop.query.emplace("config", "c.json");
    EXPECT_EQ(status(stop), 409u) << "nothing runs";
}

TEST_F(LiveServed, SaysThatTheDatabaseWasMoved) {
    EXPECT_NE(opened("").find("\"in_place\":true"), std::string::npos);
    std::filesystem::rename(folder / "a.db", folder / "b.db");
    EXPECT_NE(opened("").find("\"in_place\":false"), std::string::npos);
}

}  // namespace grainsweep::tests::live_served_test
