package skein.simulator

import java.util.regex.Pattern
import scala.util.{Random, Try}

class NamePatternSuite extends munit.FunSuite:

  private def refusal(text: String): String =
    intercept[BadArgument](NamePattern(text).matches("x")).getMessage

  test("an expression matches whole names as the JDK's does, in 5,000 random cases"):
    val random = Random(43)
    val pieces =
      Vector("a", "b", "x", ".", "[ab]", "[^a]", "[a-c]", "\\d", "\\w", "\\.", "^", "$", "\\b", "|")
    // The JDK's expressions are wrong about repetitions of the empty string: these are tested separately.
    def isEmpty(part: String)          = part.contains("\\b") || Pattern.compile(part).matcher("").matches()
    def expression(depth: Int): String =
      val parts = Vector.fill(1 + random.nextInt(4)):
        if depth > 0 && random.nextInt(3) == 0 then s"(${expression(depth - 1)})"
        else pieces(random.nextInt(pieces.size))
      parts
        .map: part =>
          if part.head == '|' || part == "^" || part == "$" || part == "\\b" then part
          else if part.head == '(' && isEmpty(part) then part
          else part + Vector("", "", "", "*", "+", "?", "*?", "{2}", "{0,2}", "{1,}")(random.nextInt(10))
        .mkString
    for case_ <- 1 to 5_000 do
      val text       = expression(3)
      val ignoreCase = random.nextBoolean()
      val name       = Vector.fill(random.nextInt(6))("abxAB1_. " (random.nextInt(9))).mkString
      val expected   = Pattern.compile(text, if ignoreCase then Pattern.CASE_INSENSITIVE else 0)
      assertEquals(
        NamePattern(text, ignoreCase).matches(name),
        expected.matcher(name).matches(),
        s"case $case_: /$text/ on '$name'${if ignoreCase then ", any case" else ""}"
      )

  test("60 nested repetitions, on which backtracking never ends, are refused in linear time"):
    for nested <-
        Seq("(.*)*" * 60 + "x", "(a*)*" * 60 + "b", "(a|a)*" * 50 + "b", "(.?)*" * 80, "((a+)+)+" * 30)
    do
      val pattern = NamePattern(nested)
      for name <- Seq("Ground", "Evader", "a" * 100) do pattern.matches(name)
    assert(NamePattern("(^x*?\\w*?(\\w.|)*){2}").matches("bA.Aa"), "of what is empty, too")
    assert(!NamePattern("(.*)*" * 60 + "x").matches("a" * 100))
    assert(NamePattern("(.*)*" * 60 + "x").matches("a" * 100 + "x"))

  test("an expression that is too large, or too costly for all names, is refused"):
    for text <- Seq(
        "((a{99}){99}){99}",
        "((a{999}\\(){999}\\(){999}",
        "((a{999}[](]){999}[[:alpha:](]){999}",
        "(?:(?:a{1,}b{999}){,9}(?:c{999}){999})"
      )
    do assertEquals(refusal(text), "the regular expression takes too long", text)
    val nested = "(" * 200 + ")" * 200
    assertEquals(refusal(nested), s"no regular expression: groups nested deeper than 50 in '$nested'")
    val pattern = NamePattern("(a?){900}")
    intercept[BadArgument]((1 to 100_000).foreach(_ => pattern.matches("a" * 50)))

  test("an invalid or unsupported expression is reported with the reason"):
    for (text, why) <- Seq(
        "("      -> "missing closing )",
        "a)"     -> "unexpected )",
        "*"      -> "missing argument to repetition operator",
        "[a"     -> "missing closing ]",
        "[b-a]"  -> "invalid character class range",
        "a{2,1}" -> "invalid repeat count",
        "(a)\\1" -> "invalid escape sequence",
        "(?=a)"  -> "invalid or unsupported Perl syntax",
        "\\q"    -> "invalid escape sequence",
        "\\u12"  -> "invalid escape sequence",
        "\\Qa"   -> "invalid escape sequence"
      )
    do assertEquals(refusal(text), s"no regular expression: $why in '$text'")

  test("character classes and escapes are supported"):
    assert(NamePattern("[[:alpha:]_]+\\x41\\u0042[\\d\\-]{2}").matches("ab_AB1-"))
    assert(!NamePattern("[^\\w]").matches("a") && NamePattern("\\S\\s").matches("a "))

  test("in a wildcard, a star stands for any text and a question mark for one letter, in any case"):
    for (wildcard, name, is) <- Seq(
        ("Car*", "car_12", true),
        ("*", "", true),
        ("?", "", false),
        ("*a*b?", "xxaybc", true),
        ("*a*b?", "xxayb", false),
        ("a.c", "abc", false),
        ("", "a", false)
      )
    do assertEquals(NamePattern.isLike(name, wildcard), is, s"$wildcard $name")
    assert(Try(NamePattern.isLike("a" * 100, "*a" * 50 + "b")).toOption.contains(false))
