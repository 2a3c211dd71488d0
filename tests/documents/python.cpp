// The module for Python: what its page shows, and what the program refuses.
#include "tests/documents/page.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::python_test {

using nlohmann::json;
using testing::HasSubstr;

struct Python : testing::Test {
    Folder folder;

    [[nodiscard]] Ended python(const std::string& script) const {
        folder.write("script.py", script);
        const auto command = "GRAINSWEEP='" + executable().string() + "' PYTHONPATH='" + source("packaging/python").string() +
                             "' PYTHONDONTWRITEBYTECODE=1 python3 script.py";
        return Process({"/bin/sh", "-c", command}, folder.path()).wait();
    }
};

TEST_F(Python, RunsThePage) {
    std::string script;
    for (const auto& block : read_page("docs/python.md").blocks)
        if (block.language == "python") script += block.text + "\n";
    script +=
        "import math\n"
        "assert table.attrs['units'] == {'wall_seconds': 's', 'force': 'N', 'length': 'm', 'deflection': 'm'}\n"
        "assert len(table) == 24 and 18 <= len(study.frame()) <= 26\n"
        "for force, length, bent in zip(table['force'], table['length'], table['deflection']):\n"
        "    assert math.isclose(bent, force * length ** 3 / 6300, rel_tol=1e-12)\n"
        "again = grainsweep.Study('beam.json', db='study.db')\n"
        "told = again.tell([{'force': 123, 'length': 0.75}])\n"
        "assert len(told) == 1 and told['point'][0] == len(study.frame()) - 1 and told['force'][0] == 123\n"
        "assert list(again.frame()['force'])[-1] == 123\n";
    const auto ended = python(script);
    EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("m 24\n"));
}

TEST_F(Python, RaisesTheSentenceOfTheProgram) {
    const auto ended = python(R"(
import grainsweep, json
campaign = {"campaign": "r", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 3]}],
            "design": {"kind": "halton", "points": 12}}
json.dump(campaign, open("r.json", "w"))
try:
    grainsweep.run("r.json")
    raise SystemExit("not refused")
except grainsweep.Refused as refused:
    assert refused.code == 2
    print(refused)
campaign["factors"][0]["between"] = [0, 1]
campaign["fixed"] = {"behaviour": "unstable"}
json.dump(campaign, open("r.json", "w"))
ended = grainsweep.run("r.json", jobs=1, keep_going=True)
assert ended["exit_code"] == 1, ended
table = grainsweep.frame("r.db", "r")
assert all(word == "unstable" for word in table["outcome"]) and len(table) == 12
assert list(grainsweep.query("r.db", "SELECT count(*) AS n FROM r")["n"]) == [12]
try:
    grainsweep.query("r.db", "DELETE FROM campaign")
    raise SystemExit("not refused")
except grainsweep.Refused:
    pass
)");
    EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("r.json: $.factors[0].between[1]: got 3; 'x1' must be a number from 0 to 1"));
}

}  // namespace grainsweep::tests::python_test
