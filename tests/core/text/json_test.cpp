#include "quell/text/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace quell {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

SourceTextPtr source(std::string text) { return std::make_shared<SourceText>(SourceText{"t.json", std::move(text)}); }

Json parse(const std::string& text) {
  Diagnostics errors;
  std::optional<Json> json = parse_json(source(text), errors);
  EXPECT_THAT(errors.render(), IsEmpty());
  return json.value_or(Json{});
}

// "line:column" of a value.
std::string place(const Position& where) { return std::to_string(where.line()) + ":" + std::to_string(where.column()); }

TEST(Json, HasValuesOfEveryKind) {
  const Json json = parse(R"({ "n": null, "b": true, "i": -12, "d": 0.5, "s": "\u00e4\n", "a": [1, [2]], "o": { "x": {} } })");
  ASSERT_EQ(json.members.size(), 7u);
  EXPECT_EQ(json.find("n")->kind, Json::Kind::null);
  EXPECT_TRUE(json.find("b")->boolean);
  EXPECT_EQ(json.find("i")->kind, Json::Kind::integer);
  EXPECT_EQ(json.find("i")->integer, -12);
  EXPECT_EQ(json.find("i")->number, -12.0);
  EXPECT_EQ(json.find("d")->kind, Json::Kind::number);
  EXPECT_EQ(json.find("d")->number, 0.5);
  EXPECT_EQ(json.find("s")->string, "ä\n");
  EXPECT_EQ(json.find("a")->elements[1].elements[0].integer, 2);
  EXPECT_EQ(json.find("o")->find("x")->kind, Json::Kind::object);
  EXPECT_EQ(json.find("none"), nullptr);
  EXPECT_EQ(json.find("a")->find("none"), nullptr);
}

TEST(Json, KeepsIntegersOf64BitsAndTurnsLargerOnesIntoNumbers) {
  const Json json = parse("[9223372036854775807, -9223372036854775808, 9223372036854775808, 1e3, 18446744073709551616]");
  EXPECT_EQ(json.elements[0].integer, INT64_MAX);
  EXPECT_EQ(json.elements[1].integer, INT64_MIN);
  EXPECT_EQ(json.elements[2].kind, Json::Kind::number);
  EXPECT_EQ(json.elements[2].number, 0x1p63);
  EXPECT_EQ(json.elements[3].kind, Json::Kind::number);
  EXPECT_EQ(json.elements[4].number, 0x1p64);
}

TEST(Json, KnowsWhereEveryKeyAndValueStands) {
  const Json json = parse("{\n  \"a\" : 12,\"b\":[ true ,-0.5,\n\t{}, \"x\\\"y\" ], // c\n  \"ü\": {\"d\":null}\n}");
  EXPECT_EQ(place(json.where), "1:1");
  EXPECT_EQ(place(json.members[0].where), "2:3");
  EXPECT_EQ(place(json.members[0].value.where), "2:9");
  EXPECT_EQ(place(json.members[1].where), "2:12");
  const Json& list = json.members[1].value;
  EXPECT_EQ(place(list.where), "2:16");
  EXPECT_EQ(place(list.elements[0].where), "2:18");
  EXPECT_EQ(place(list.elements[1].where), "2:24");
  EXPECT_EQ(place(list.elements[2].where), "3:2");
  EXPECT_EQ(place(list.elements[3].where), "3:6");
  EXPECT_EQ(place(json.members[2].where), "4:3");
  EXPECT_EQ(place(json.members[2].value.where), "4:9");  // ü takes two bytes
  EXPECT_EQ(place(json.members[2].value.members[0].value.where), "4:14");
}

TEST(Json, MayHaveCommentsAndTrailingCommas) {
  const Json json =
      parse("// first\n{ /* , */ \"a\": [1, 2, /* ] */ ], // }\n  \"b\": \"// no, comment\", \"c\": \"/*,]\", }\n// last");
  EXPECT_EQ(json.find("a")->elements.size(), 2u);
  EXPECT_EQ(json.find("b")->string, "// no, comment");
  EXPECT_EQ(json.find("c")->string, "/*,]");
  EXPECT_EQ(place(json.members[1].where), "3:3");
}

TEST(Json, MayStartWithAByteOrderMarkAndHaveLinesOfAnySystem) {
  EXPECT_EQ(parse("\xEF\xBB\xBF{ \"a\": 1 }").find("a")->integer, 1);
  const Json json = parse("{\r\n  \"a\": 1,\r\n  \"b\": 2\r\n}\r\n");
  EXPECT_EQ(place(json.members[1].where), "3:3");
}

TEST(Json, TellsEveryKeyThatIsRepeatedAndKeepsTheFirst) {
  Diagnostics errors;
  const auto json = parse_json(source("{ \"a\": 1, \"b\": { \"c\": 1,\n \"c\": 2, \"c\": 3 },\n \"a\": 4 }"), errors);
  ASSERT_TRUE(json);
  EXPECT_EQ(json->members.size(), 2u);
  EXPECT_EQ(json->find("a")->integer, 1);
  EXPECT_EQ(errors.size(), 3u);
  EXPECT_THAT(errors.render(), HasSubstr("t.json:2:2: error: the key 'c' is there already, in line 1; expected it once\n"));
  EXPECT_THAT(errors.render(), HasSubstr("t.json:2:10: error: the key 'c' is there already, in line 1; expected it once\n"));
  EXPECT_THAT(errors.render(), HasSubstr("t.json:3:2: error: the key 'a' is there already, in line 1; expected it once\n"));
}

TEST(Json, NestsTwoHundredDeepAndNoDeeper) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  Diagnostics errors;
  EXPECT_TRUE(parse_json(source(nested(200)), errors));
  EXPECT_FALSE(parse_json(source(nested(201)), errors));
  EXPECT_FALSE(parse_json(source(std::string(10'000'000, '[')), errors));
  EXPECT_THAT(errors.render(), HasSubstr("t.json:1:201: error: brackets are nested more than 200 deep"));
}

TEST(Json, DoesNotEndAtACharacterZero) {
  Diagnostics errors;
  EXPECT_FALSE(parse_json(source(std::string("{ \"a\": 1 }") + std::string(1, 0) + ", x"), errors));
  EXPECT_THAT(errors.render(), HasSubstr("t.json:1:11: error: unexpected control character 0"));
}

// A text that is no JSON, and the error that it must give.
struct Mistake {
  const char* text;
  const char* error;
};
void PrintTo(const Mistake& mistake, std::ostream* stream) { *stream << mistake.text; }

class JsonMistake : public testing::TestWithParam<Mistake> {};

TEST_P(JsonMistake, IsToldInPlainWords) {
  Diagnostics errors;
  EXPECT_FALSE(parse_json(source(GetParam().text), errors));
  const std::string rendered = errors.render();
  EXPECT_EQ(rendered.substr(0, rendered.find('\n')), std::string("t.json:") + GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    OfSyntax, JsonMistake,
    testing::Values(
        Mistake{"", "1:1: error: the text is empty; expected a JSON object"},
        Mistake{" // nothing\n", "2:1: error: the text is empty; expected a JSON object"},
        Mistake{"{ \"a\": 1 \"b\": 2 }", "1:10: error: missing ',' before this"},
        Mistake{"[1\n 2]", "2:2: error: missing ',' before this"}, Mistake{"[1, 2 {}]", "1:7: error: missing ',' before this"},
        Mistake{"{ \"a\": 1,, }", "1:10: error: one ',' too many; expected a key in double quotes"},
        Mistake{"{,}", "1:2: error: one ',' too many; expected a key in double quotes"},
        Mistake{"[,]", "1:2: error: expected a value before this ','"},
        Mistake{"[1,,2]", "1:4: error: expected a value before this ','"},
        Mistake{"{ \"a\": }", "1:8: error: expected a value before this '}'"},
        Mistake{"{ \"a\" 1 }", "1:7: error: expected ':' between the key and its value, got '1'"},
        Mistake{"{ \"a\" = 1 }", "1:7: error: expected ':' between the key and its value, got '='"},
        Mistake{"{ \"a\", 1 }", "1:6: error: expected ':' between the key and its value, got ','"},
        Mistake{"[1: 2]", "1:3: error: unexpected ':' in a list; only an object, in braces, has keys"},
        Mistake{"{ a: 1 }", "1:3: error: the key 'a' needs straight double quotes"},
        Mistake{"{ 'a': 1 }", "1:3: error: unexpected '''; text stands in straight double quotes"},
        Mistake{"{ \"a\": “x” }", "1:8: error: unexpected '“'; text stands in straight double quotes"},
        Mistake{"{ 5: 1 }", "1:3: error: the key '5' needs straight double quotes"},
        Mistake{"{ [1]: 1 }", "1:3: error: unexpected '['; expected a key in double quotes"},
        Mistake{"[True]",
                "1:2: error: unknown word 'True'; expected true, false, null, a number, or text in straight double quotes"},
        Mistake{"[nan]",
                "1:2: error: unknown word 'nan'; expected true, false, null, a number, or text in straight double quotes"},
        Mistake{"tru", "1:1: error: unknown word 'tru'; expected true, false, null, a number, or text in straight double quotes"},
        Mistake{"[01]", "1:2: error: '01' is no JSON number; expected one like 8, -0.5 or 1e-3"},
        Mistake{"[.5]", "1:2: error: '.5' is no JSON number; expected one like 8, -0.5 or 1e-3"},
        Mistake{"[+5]", "1:2: error: '+5' is no JSON number; expected one like 8, -0.5 or 1e-3"},
        Mistake{"[5., 1]", "1:2: error: '5.' is no JSON number; expected one like 8, -0.5 or 1e-3"},
        Mistake{"-", "1:1: error: '-' is no JSON number; expected one like 8, -0.5 or 1e-3"},
        Mistake{"[1, 1e999]", "1:5: error: this number is too large; the largest is about 1.8e308"},
        Mistake{"{ \"a\": \"x }\n", "1:8: error: this string is never closed; expected '\"' before the end of the line"},
        Mistake{"\"x", "1:1: error: this string is never closed; expected '\"' before the end of the line"},
        Mistake{"\"x\\", "1:1: error: this string is never closed; expected '\"' before the end of the line"},
        Mistake{"[\"C:\\quell\"]", "1:2: error: unknown escape '\\q' in this string; a backslash is written '\\\\'"},
        Mistake{"[\"\\u12\"]", "1:2: error: '\\u' takes four hexadecimal digits, and a surrogate its other half"},
        Mistake{"[\"\\ud800\"]", "1:2: error: '\\u' takes four hexadecimal digits, and a surrogate its other half"},
        Mistake{"[\"a\tb\"]", "1:4: error: a tab inside of a string is written \\t"},
        Mistake{"[\"a\x01\"]", "1:4: error: a control character inside of a string"},
        Mistake{"[1, \x02]", "1:5: error: unexpected control character 2"},
        Mistake{"{ \"a\": 1", "1:1: error: this '{' is never closed; expected '}'"},
        Mistake{"{\n  \"a\": {\n    \"b\": 1\n  \n}\n",
                "2:8: error: this '{' is never closed, as the indentation tells; expected '}'"},
        Mistake{"{ \"a\": [1 }", "1:11: error: this '}' does not match the '[' of line 1, column 8; expected ']'"},
        Mistake{"{ \"a\": 1 }}", "1:11: error: this '}' closes nothing; remove it"},
        Mistake{"{} {}", "1:4: error: unexpected '{' after the end of the value; expected the end of the text"},
        Mistake{"{} /", "1:4: error: unexpected '/'; comments start with '//' or '/*'"},
        Mistake{"{} /* x", "1:4: error: this comment is never closed; expected '*/'"},
        Mistake{"{ \"a\": 1; }", "1:9: error: unexpected ';'; expected ',' or '}'"},
        Mistake{"[1; 2]", "1:3: error: unexpected ';'; expected ',' or ']'"},
        Mistake{"\xFF\xFE{", "1:1: error: this is UTF-16; expected UTF-8 text"},
        Mistake{"[\"gr\xFCn\"]", "1:5: error: this byte is not valid UTF-8; expected UTF-8 text"}));

TEST(Json, IsExcerptedForMessages) {
  EXPECT_EQ(excerpt(parse("null")), "null");
  EXPECT_EQ(excerpt(parse("-3")), "-3");
  EXPECT_EQ(excerpt(parse("0.1")), "0.1");
  EXPECT_EQ(excerpt(parse("\"a\\\"b\\n\"")), "\"a\\\"b\\n\"");
  EXPECT_EQ(excerpt(parse("[]")), "[]");
  EXPECT_EQ(excerpt(parse("[1]")), "[...]");
  EXPECT_EQ(excerpt(parse("{ \"a\": 1 }")), "{...}");
  // 40 bytes at most, and no half of a character.
  EXPECT_EQ(excerpt(parse("\"" + std::string(50, 'x') + "\"")), "\"" + std::string(40, 'x') + "...\"");
  EXPECT_EQ(excerpt(parse("\"" + std::string(39, 'x') + "ää\"")), "\"" + std::string(39, 'x') + "...\"");
}

TEST(ReadText, GivesTheTextUnderItsNameWithoutAByteOrderMark) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "quell_read_text.json";
  std::ofstream(file) << "\xEF\xBB\xBF{}\n";
  const SourceTextPtr text = read_text(file, Fault::usage);
  EXPECT_EQ(text->name, file.string());
  EXPECT_EQ(text->text, "{}\n");
}

TEST(ReadText, RefusesWhatIsMissingAFolderOrTooLarge) {
  const auto refusal = [](const std::filesystem::path& file, std::size_t most) -> std::string {
    try {
      read_text(file, Fault::input, most);
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::input);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("nowhere/x", 10), "nowhere/x: cannot be opened: No such file or directory");
  EXPECT_EQ(refusal(testing::TempDir(), 10), testing::TempDir() + ": is a folder; expected a file");
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "quell_large.json";
  std::ofstream(file) << std::string((1 << 20) + 1, ' ');
  EXPECT_EQ(refusal(file, 1 << 20), file.string() + ": is larger than 1 MiB, the most that is read");
  EXPECT_EQ(refusal(file, 2 << 20), "");
}

}  // namespace
}  // namespace quell
