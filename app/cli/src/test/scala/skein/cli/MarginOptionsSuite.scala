package skein.cli

import skein.report.PaperReport
import skein.scenario.Scenarios

class MarginOptionsSuite extends munit.FunSuite:
  private given Scenarios = PaperReport.scenarios

  private val program = Seq("--", "python", "my.py", "{port}")

  private def mistake(words: String*) = MarginCommand().checked(words).left.toOption

  test("words after -- belong to the program, even if they look like options"):
    assertEquals(mistake("--scenario", "duel", "--", "sh", "-c", "--judge", "--nothing"), None)
    assertEquals(ObserveCommand.checked(Seq("--", "sh", "-c", "exit 3")), Right(()))

  test("a mistake is one line with the option's name"):
    for
      (words, line) <- Seq(
        Seq("--scenario", "duel") -> "expected a program behind --, for example -- python my.py {port}",
        (Seq("--set", "pairs=2") ++ program)   -> "--set: expected with --scenario, whose settings they are",
        (Seq("--judge", "closest") ++ program) ->
          "--judge: expected one of printed, contacts, separation, distance, distance:NORTH,EAST,DOWN, got 'closest'",
        (Seq(
          "--judge",
          "distance"
        ) ++ program) -> "--judge: expected two vehicles or more for distance, got 1",
        (Seq(
          "--scenario",
          "duel",
          "--settings",
          "x.json"
        ) ++ program) -> "--settings: expected without --scenario",
        (Seq("--scenario", "duel", "--link", "vpn", "--link", "vpn") ++ program) ->
          "--link, --delays: expected each link once, got 'vpn' twice",
        (Seq("--scenario", "duel", "--link", "none") ++ program) ->
          "--link: expected one with latency, got none alone",
        (Seq("--scenario", "duel", "--repeats", "0") ++ program) -> "--repeats: expected 1 to 100, got 0",
        (Seq("--scenario", "duel", "--skip", "60s") ++ program)  ->
          "--skip: expected less than the 60 s of --seconds, got '60s'",
        (Seq("--scenario", "duel", "--tolerance", "5", "--within", "1") ++ program) ->
          "--tolerance, --within: expected one of them",
        (Seq("--scenario", "duel", "--delays", "1..2") ++ program) ->
          "--delays: expected FROM..TO/COUNT, for example 50ms..200ms/4, got '1..2'"
      )
    do assertEquals(mistake(words*), Some(line))
