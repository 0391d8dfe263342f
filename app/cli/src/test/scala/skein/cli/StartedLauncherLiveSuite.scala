package skein.cli

import java.nio.file.Files
import skein.testing.{TemporaryFolders, Unhurried}

/** Commands of the README as a user starts them: through the staged launcher script, in a process of their
  * own.
  */
class StartedLauncherLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private lazy val scratch = temporaryFolder()

  private def said(words: String*): String =
    assume(Files.exists(Launchers.staged), "./sbtw cli/stage makes the launcher")
    val (status, said) = Launchers.run(Launchers.staged, words)
    assertEquals(status, 0, said)
    assert(!said.contains("WARNING"), said)
    said

  test("./skein --help"):
    val help = said("--help")
    for command <- Main.commands do assert(help.contains(command.name), command.name)

  test("./skein --version"):
    val version = said("--version")
    assert(version.matches("Skein \\d+\\.\\d+\\.\\d+\\S*, Java \\d+\\S*\\s*"), version)

  test("words behind -- are executed unchanged, options and dashes included"):
    val program = Seq("sh", "-c", "echo \"$@\"", "sh", "-J1", "--", "-v")
    assert(said(Seq("observe", "--listen", "127.0.0.1:0", "--") ++ program*).contains("\n-J1 -- -v\n"))

  test("./skein fly --clock virtual"):
    val flown =
      said("fly", "--clock", "virtual", "--duration", "12s", "--out", scratch.resolve("flown").toString)
    assert(flown.contains("predictive"), flown)
    assert(Files.exists(scratch.resolve("flown/report.html")), flown)
