package skein.cli

import scala.sys.process.{Process, ProcessLogger}

/** Completion scripts, tested with bash itself. */
class CompletionSuite extends munit.FunSuite:

  private def printed(words: String*): (Int, String) =
    val ran = Ran.of(Main.run(words))
    (ran.status, ran.said)

  /** Bash's suggestions for a line whose last word is being typed. */
  private def offered(line: String*): Set[String] =
    val script  = printed("completion", "bash")._2
    val words   = line.map(word => s"'$word'").mkString(" ")
    val program =
      s"$script\nCOMP_WORDS=($words); " +
        s"COMP_CWORD=${line.size - 1}; _skein; printf '%s\\n' \"$${COMPREPLY[@]}\""
    val out    = StringBuilder()
    val status =
      Process(Seq("bash", "-c", program)).!(ProcessLogger(text => out.append(text).append('\n'): Unit))
    assertEquals(status, 0, out.toString)
    out.toString.linesIterator.filter(_.nonEmpty).toSet

  test("bash completes commands"):
    assertEquals(offered("./skein", "re"), Set("report", "replay"))
    assertEquals(offered("./skein", ""), Main.commands.map(_.name).toSet + "--help" + "--version")

  test("bash completes every option of every command in its help"):
    for command <- Main.commands do
      val flags = offered("skein", command.name, "--")
      assertEquals(flags, command.options.map(_.flag).toSet + "--help", command.name)
      for flag <- flags if flag != "--help" do
        assert(command.help.contains(s"$flag"), s"${command.name} $flag")

  test("bash completes known values, and file names where any value is valid"):
    assertEquals(offered("skein", "fly", "--clock", ""), Set("real", "virtual"))
    assertEquals(offered("skein", "fly", "--loop", "p"), Set("paused", "predictive", "plan"))
    assertEquals(offered("skein", "report", "build.s"), offered("skein", "fly", "--out", "build.s"))

  test("zsh completes every command and option, with a description"):
    val (status, script) = printed("completion", "zsh")
    assertEquals(status, 0)
    assert(script.startsWith("#compdef skein"))
    for command <- Main.commands do
      assert(script.contains(s"'${command.name}:"), command.name)
      for option <- command.options do assert(script.contains(s"'*${option.flag}["), option.flag)
    // Quotes are closed in every line.
    for line <- script.linesIterator do
      assertEquals(line.replace("'\\''", "").count(_ == '\'') % 2, 0, line)

  test("an unknown shell is refused with a list of known ones"):
    assertEquals(
      printed("completion", "fish"),
      (1, "skein completion: expected one of bash, zsh, got fish\n")
    )
    assertEquals(printed("completion"), (1, "skein completion: expected one of bash, zsh, got nothing\n"))
