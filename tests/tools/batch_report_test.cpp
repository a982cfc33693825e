#include "tools/batch/batch_report.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace gim {
namespace {

using State = BatchRow::State;

BatchRow done_row(const std::string& name) {
    BatchRow row;
    row.name = row.path = name;
    row.state = State::kDone;
    row.figures.bytes = 1234;
    row.figures.input_bytes = 56789;
    row.figures.triangles = 1000;
    row.figures.psnr = 61.25;
    row.figures.seconds = 1.5;
    row.figures.layout = "tiles";
    row.thumbnail = {1, 2, 3, 4};
    return row;
}

BatchPage page_of_all_states() {
    BatchPage page;
    page.options = {"--psnr 60", ""};
    page.rows = {done_row("a.ply"), done_row("<b>&\"\x01\xFF.ply"), {}, {}, {}};
    page.rows[1].figures.psnr.reset();
    page.rows[1].thumbnail.clear();
    page.rows[2].name = page.rows[2].path = "bad.ply";
    page.rows[2].state = State::kFailed;
    page.rows[2].reason = "input: <nothing> in it";
    page.rows[3].name = "runs.ply";
    page.rows[3].state = State::kRunning;
    page.rows[4].name = "waits.ply";
    page.notes = {"A note & more."};
    return page;
}

size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
    return found;
}

// Tags of the page in order, "/" before those that close. Fails if a tag has an attribute without quotes.
std::vector<std::string> tags_of(const std::string& html) {
    std::vector<std::string> tags;
    for (size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
        size_t end = at + 1;
        for (bool quoted = false; end < html.size() && (quoted || html[end] != '>'); ++end) {
            EXPECT_TRUE(quoted || html[end] != '<') << html.substr(at, 80);
            if (html[end] == '"') quoted = !quoted;
        }
        std::string tag = html.substr(at + 1, end - at - 1);
        const bool is_empty = tag.ends_with('/');
        tag = tag.substr(0, tag.find_first_of(" \n/", 1));
        tags.push_back(tag);
        if (is_empty) tags.push_back("/" + tag);
        at = tag == "style" || tag == "script" ? html.find("</" + tag, end) : end;
    }
    return tags;
}

TEST(BatchReport, EveryElementIsClosedInOrder) {
    const std::set<std::string> open_only = {"!DOCTYPE", "meta", "img"};
    std::vector<std::string> stack;
    for (const std::string& tag : tags_of(batch_html(page_of_all_states()))) {
        if (open_only.contains(tag)) continue;
        if (!tag.starts_with('/')) {
            stack.push_back(tag);
            continue;
        }
        ASSERT_FALSE(stack.empty()) << tag;
        EXPECT_EQ("/" + stack.back(), tag);
        stack.pop_back();
    }
    EXPECT_TRUE(stack.empty());
}

TEST(BatchReport, HasARowForEachInput) {
    const BatchPage page = page_of_all_states();
    const std::string html = batch_html(page);
    const std::string body = html.substr(html.find("<tbody>"));
    EXPECT_EQ(count(body, "<tr>"), page.rows.size());
    EXPECT_EQ(count(body, "<td"), page.rows.size() * 10);
    for (const char* state : {">done<", ">failed<", ">running<", ">waiting<"})
        EXPECT_GE(count(body, state), 1U) << state;
}

TEST(BatchReport, NamesAndReasonsAreText) {
    const std::string html = batch_html(page_of_all_states());
    EXPECT_NE(html.find("&lt;b&gt;&amp;&quot;\xEF\xBF\xBD\xEF\xBF\xBD.ply"), std::string::npos);
    EXPECT_NE(html.find("input: &lt;nothing&gt; in it"), std::string::npos);
    EXPECT_EQ(html.find('\x01'), std::string::npos);
    EXPECT_EQ(html.find('\xFF'), std::string::npos);
}

TEST(BatchReport, TellsAllOptionsThatOutputsWereMadeWith) {
    const std::string html = batch_html(page_of_all_states());
    EXPECT_EQ(count(html, "<dt>options</dt>"), 2U);
    EXPECT_NE(html.find("<code>--psnr 60</code>"), std::string::npos);
}

TEST(BatchReport, AFailedFileHasNoPictureOfAnEarlierRun) {
    BatchPage page = page_of_all_states();
    page.rows[0].state = State::kFailed;
    EXPECT_EQ(count(batch_html(page), "<img"), 0U);
}

TEST(BatchReport, PicturesAreInside) {
    const std::string html = batch_html(page_of_all_states());
    EXPECT_NE(html.find("data:image/png;base64,AQIDBA=="), std::string::npos);
    EXPECT_EQ(count(html, "<img"), 1U);
    for (const char* outside : {"http:", "https:", "//cdn", "<link"}) EXPECT_EQ(html.find(outside), std::string::npos);
}

TEST(BatchReport, TheScatterHasADotForEachFileWithAPsnr) {
    BatchPage page = page_of_all_states();
    EXPECT_EQ(count(batch_html(page), "<title>"), 2U) << "of the page and of one dot";
    page.rows.erase(page.rows.begin());
    EXPECT_EQ(batch_html(page).find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace gim
