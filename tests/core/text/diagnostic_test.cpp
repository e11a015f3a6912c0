#include "quell/text/diagnostic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace quell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SourceTextPtr source(std::string text, std::string name = "a.json") {
  return std::make_shared<SourceText>(SourceText{std::move(name), std::move(text)});
}

// What one error at an offset looks like.
std::string render(const std::string& text, std::size_t offset) {
  Diagnostics errors;
  errors.error({source(text), offset}, "wrong");
  return errors.render();
}

TEST(Position, CountsLinesAndBytesFromOne) {
  const SourceTextPtr text = source("ab\nüc\r\n\nd");
  EXPECT_EQ((Position{text, 0}.line()), 1);
  EXPECT_EQ((Position{text, 2}.column()), 3);  // the line feed belongs to its line
  EXPECT_EQ((Position{text, 5}.line()), 2);
  EXPECT_EQ((Position{text, 5}.column()), 3);
  EXPECT_EQ((Position{text, 8}.line()), 3);
  EXPECT_EQ((Position{text, 9}.line()), 4);
  EXPECT_EQ((Position{text, 999}.line()), 4);  // behind the end
  EXPECT_EQ((Position{}.line()), 0);
}

TEST(Diagnostics, ShowTheLineAndACaret) {
  EXPECT_EQ(render("first\nsecond line\nthird", 13),
            "a.json:2:8: error: wrong\n"
            "    second line\n"
            "           ^");
}

TEST(Diagnostics, KeepTabsSoThatTheCaretStandsUnderThePlace) {
  EXPECT_EQ(render("\t\tx\ty", 4), "a.json:1:5: error: wrong\n    \t\tx\ty\n    \t\t \t^");
}

TEST(Diagnostics, CountBytesForTheColumnAndCharactersForTheCaret) {
  EXPECT_EQ(render("größer x", 9), "a.json:1:10: error: wrong\n    größer x\n           ^");
}

TEST(Diagnostics, EndALineBeforeItsCarriageReturn) {
  EXPECT_EQ(render("ab\r\nc", 1), "a.json:1:2: error: wrong\n    ab\n     ^");
}

TEST(Diagnostics, StandAtTheEndOfATextThatEndsTooSoon) { EXPECT_EQ(render("{\n", 2), "a.json:2:1: error: wrong\n    \n    ^"); }

TEST(Diagnostics, ShowOfALongLineWhatIsNearThePlace) {
  const std::string text = std::string(300, 'a') + "X" + std::string(300, 'b');
  EXPECT_EQ(render(text, 300), "a.json:1:301: error: wrong\n    ..." + std::string(70, 'a') + "X" + std::string(69, 'b') +
                                   "...\n       " + std::string(70, ' ') + "^");
  EXPECT_EQ(render(std::string(160, 'a'), 0), "a.json:1:1: error: wrong\n    " + std::string(160, 'a') + "\n    ^");
  // Characters are not cut in half.
  std::string umlauts;
  for (int i = 0; i < 200; ++i) umlauts += "ü";
  const std::string shown = render(umlauts, 201);
  EXPECT_EQ(shown.find("?"), std::string::npos) << shown;
}

TEST(Diagnostics, LetNothingReachATerminalThatIsNotText) {
  EXPECT_EQ(render("a\x1b[31mb\xffz", 0), "a.json:1:1: error: wrong\n    a?[31mb?z\n    ^");
}

TEST(Diagnostics, AreSortedByPlaceAndFilesByTheirFirstError) {
  const SourceTextPtr a = source("abc\ndef", "a.json"), b = source("xyz", "b.json");
  Diagnostics errors;
  errors.error({b, 2}, "three");
  errors.error({a, 5}, "two");
  errors.error({a, 1}, "one");
  errors.error({b, 0}, "four");
  EXPECT_EQ(errors.render(),
            "b.json:1:1: error: four\n    xyz\n    ^\nb.json:1:3: error: three\n    xyz\n      ^\n"
            "a.json:1:2: error: one\n    abc\n     ^\na.json:2:2: error: two\n    def\n     ^");
}

TEST(Diagnostics, TellTheSameOnceAndDifferentThingsOfOnePlaceInTheirOrder) {
  const SourceTextPtr text = source("abc");
  Diagnostics errors;
  errors.error({text, 1}, "z");
  errors.error({text, 1}, "a");
  errors.error({text, 1}, "z");
  EXPECT_EQ(errors.render(), "a.json:1:2: error: z\n    abc\n     ^\na.json:1:2: error: a\n    abc\n     ^");
}

TEST(Diagnostics, AddNotes) {
  const SourceTextPtr a = source("abc", "a.json"), b = source("x\nyz", "b.json");
  Diagnostics errors;
  std::vector<Note> notes(2);
  notes[0].where = {b, 3}, notes[0].message = "included from here";
  notes[1].message = "no place";
  errors.error({a, 0}, "wrong", notes);
  EXPECT_EQ(errors.render(), "a.json:1:1: error: wrong\n    abc\n    ^\nb.json:2:2: note: included from here\nnote: no place");
}

TEST(Diagnostics, NeedNoPlace) {
  Diagnostics errors;
  errors.error({}, "wrong");
  EXPECT_EQ(errors.render(), "error: wrong");
}

TEST(Diagnostics, AreThrownWithTheirFaultWhenThereAreAny) {
  Diagnostics errors;
  EXPECT_NO_THROW(errors.throw_if_any());
  errors.error({source("x"), 0}, "wrong");
  try {
    errors.throw_if_any(Fault::input);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::input);
    EXPECT_STREQ(error.what(), "a.json:1:1: error: wrong\n    x\n    ^");
  }
}

TEST(Diagnostics, AreCountedWhenTheyAreTooMany) {
  const SourceTextPtr text = source(std::string(300, 'x'));
  Diagnostics errors;
  for (std::size_t i = 0; i < 300; ++i) errors.error({text, i}, "wrong");
  EXPECT_THAT(errors.render(), HasSubstr("\nand 100 more errors"));
}

TEST(Nearest, FindsWhatWasMistyped) {
  const std::vector<std::string> names{"sigma_color", "sigma_normal", "radius", "mode"};
  EXPECT_THAT(nearest("sigma_colour", names), ElementsAre("sigma_color"));  // inserted
  EXPECT_THAT(nearest("radus", names), ElementsAre("radius"));              // left out
  EXPECT_THAT(nearest("rodius", names), ElementsAre("radius"));             // replaced
  EXPECT_THAT(nearest("mdoe", names), ElementsAre("mode"));                 // swapped: one mistake, not two
  EXPECT_THAT(nearest("strength", names), IsEmpty());
  EXPECT_THAT(nearest("", names), IsEmpty());
}

TEST(Nearest, AllowsAThirdOfTheLengthRoundedUp) {
  EXPECT_THAT(nearest("abcxyz", {"abcdef"}), IsEmpty());              // 3 of 6
  EXPECT_THAT(nearest("abcdyz", {"abcdef"}), ElementsAre("abcdef"));  // 2 of 6
  EXPECT_THAT(nearest("a", {"b"}), IsEmpty());
  EXPECT_THAT(nearest("ab", {"a"}), ElementsAre("a"));
}

TEST(Nearest, PutsTheBestFirstAndNoMoreThanThree) {
  EXPECT_THAT(nearest("color1", {"colour2", "color2", "color3", "color12", "color"}), ElementsAre("color2", "color3", "color12"));
  EXPECT_THAT(nearest("RADIUS", {"radios", "radius"}), ElementsAre("radius"));
  EXPECT_THAT(nearest("Modes", {"modes_a", "mode", "modes"}), ElementsAre("modes", "mode"));
}

TEST(DidYouMean, AsksOnlyWhenSomethingIsNear) {
  EXPECT_EQ(did_you_mean("simga", {"sigma", "radius"}), "; did you mean 'sigma'?");
  EXPECT_EQ(did_you_mean("colr", {"color", "colr2"}), "; did you mean 'color' or 'colr2'?");
  EXPECT_EQ(did_you_mean("else", {"sigma", "radius"}), "");
}

TEST(ListNames, JoinsAsASentenceDoes) {
  EXPECT_EQ(list_names({}), "");
  EXPECT_EQ(list_names({"a"}), "'a'");
  EXPECT_EQ(list_names({"a", "b"}), "'a' or 'b'");
  EXPECT_EQ(list_names({"a", "b", "c"}, "and"), "'a', 'b' and 'c'");
}

}  // namespace
}  // namespace quell
