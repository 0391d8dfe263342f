package skein.cli

import java.nio.file.{Files, Path}
import mainargs.ParserForClass
import skein.policy.{Action, Agent, Policy, Observation}
import skein.record.MemoryRecorder
import skein.report.PaperReport
import skein.scenario.{PaperDuel, Scenario, ScenarioKind, Scenarios}
import skein.testing.{TemporaryFolders, Unhurried}

/** Mistakes are reported in one line each, before any long work begins. */
class BadInputSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given Scenarios = PaperReport.scenarios

  private def assertRefused(command: Command[?], arguments: Seq[String], expected: String)(using
      munit.Location
  ): Unit =
    val ran = Ran.of(command.run(arguments))
    assert(ran.status != 0)
    assert(clue(ran.said).contains(expected), s"expected: $expected")
    assert(ran.said.linesIterator.size <= 2)

  folder.test("a folder that cannot be created is reported before the flight"): path =>
    val file     = Files.writeString(path.resolve("file"), "").toString
    val commands = Seq(
      FlyCommand(),
      SpreadCommand("skein.cli.Main"),
      SearchCommand("skein.cli.Main"),
      LearnCommand("skein.cli.Main"),
      BudgetCommand("skein.cli.Main"),
      LatencyCommand
    )
    for command <- commands do
      assertRefused(command, Seq("--out", s"$file/in"), "--out: cannot write into the folder")
      assertRefused(command, Seq("--out", ""), "--out: expected a folder, got ''")

  folder.test("flights in virtual time that memory cannot hold are refused"): path =>
    val flight = Seq("--duration", "60000s", "--period", "100ms")
    val told   =
      "--duration: expected at most 50000 s in virtual time, which keeps the records of 2 vehicles " +
        "in memory, got 60000 s"
    assertRefused(SpreadCommand("skein.cli.Main"), flight, told)
    assertRefused(FlyCommand(), flight ++ Seq("--clock", "virtual", "--out", s"$path/out"), told)
    assert(Files.notExists(path.resolve("out")))

  folder.test("an exception of a scenario's own code is reported in a line, and leaves no folder"): path =>
    final case class Broken(where: String = "") extends Scenario:
      def agents: Vector[Agent] =
        if where == "agents" then throw IllegalStateException("nobody") else PaperDuel().agents
    object Program extends SkeinApp(ScenarioKind(Broken()))
    val ran = Ran.of(Program.run(Seq("fly", "--set", "where=agents", "--out", s"$path/out")))
    assertEquals(ran.status, 1)
    assert(clue(ran.said).matches(
      "skein fly: the scenario broken failed: java.lang.IllegalStateException: nobody " +
        "\\(BadInputSuite.scala:\\d+\\)\n"
    ))
    assert(Files.notExists(path.resolve("out")))

  folder.test("if a policy throws at its first decision, only that is reported"): path =>
    object Lost extends Policy:
      type Memory = Unit
      def start: Unit                                             = ()
      def choose(seen: Observation, memory: Unit): (Action, Unit) = throw Exception("no way")
    final case class Led() extends Scenario:
      def agents: Vector[Agent] = PaperDuel().agents.map(_.copy(policy = Lost))
    object Program extends SkeinApp(ScenarioKind(Led()))
    val flight = s"fly --clock virtual --loop stream --link direct --duration 1s --out $path/out"
    val ran    = Ran.of(Program.run(flight.split(' ').toSeq))
    assertEquals(ran.status, 1)
    assert(
      clue(
        ran.said
      ).linesIterator.exists(_.matches("skein fly: stream-direct failed: the policy of .*: no way .*"))
    )
    assert(!ran.said.contains("nothing was decided"))

  test("a certificates' folder without a name, and more flights than can be kept, are refused"):
    assertRefused(ClusterCommand, Seq("certificates", ""), "certificates: expected a folder, got ''")
    assertRefused(
      SpreadCommand("skein.cli.Main"),
      Seq("--seeds", "100001"),
      "--seeds: expected 1 to 100000, got 100001"
    )
    assertRefused(
      TortureCommand("skein.cli.Main"),
      Seq("--seeds", "1000001", "--workers", "1"),
      "--seeds: expected 1 to 1000000 with --workers or --cluster, got 1000001"
    )

  test("seeds beyond the largest number are refused"):
    assertRefused(
      TortureCommand("skein.cli.Main"),
      Seq("--first", Long.MaxValue.toString, "--seeds", "2"),
      s"--first: expected up to ${Long.MaxValue - 1}, since the other seeds follow it"
    )

  folder.test("a view that could not be shown is reported before the flight"): path =>
    val out                                           = path.resolve("out")
    def refused(expected: String)(arguments: String*) =
      assertRefused(FlyCommand(), arguments ++ Seq("--out", out.toString), expected)
    refused("--view-port: expected with --view")("--view-port", "9000")
    refused("--view-port: expected 0 to 65535, got 65536")("--view", "--view-port", "65536")
    refused("./skein replay --view FILE")("--view", "--clock", "virtual")
    assertRefused(
      ReplayCommand(),
      Seq("--view-port", "9000", "x.duckdb"),
      "--view-port: expected with --view"
    )

  test("an invalid value of a setting is reported with its option"):
    assertRefused(FlyCommand(), Seq("--link", "vnp"), "skein fly: --link: unknown latency profile \"vnp\"")
    assertRefused(FlyCommand(), Seq("--loop", "streem"), "skein fly: --loop: no loop 'streem'")
    assertRefused(FlyCommand(), Seq("--loop", "paused,plan"), "; several as --loop ONE --loop OTHER")
    assertRefused(
      FlyCommand(),
      Seq("--as-paper", "--loop", "plan"),
      "--as-paper flies the paper's loops: expected no --loop beside it, got plan"
    )
    assertRefused(FlyCommand(), Seq("--duration=-5s"), "--duration: expected a duration that is not negative")
    assertRefused(
      FlyCommand(),
      Seq("--duration", "0s"),
      "skein fly: --duration: expected two periods (200.0 ms)"
    )
    assertRefused(
      FlyCommand(),
      Seq("--period", "1min"),
      "skein fly: --period: expected half the duration (30000.0 ms) or less, got 60000.0 ms"
    )
    assertRefused(
      FlyCommand(),
      Seq("--period", "1min", "--duration", "90s"),
      "skein fly: --duration: expected two periods (120000.0 ms) or more, got 90000.0 ms"
    )
    assertRefused(FlyCommand(), Seq("--deadline", "0s"), "skein fly: --deadline: expected more than 0")
    assertRefused(FlyCommand(), Seq("--scenario", "convoi"), "skein fly: --scenario: expected duel, ")

  test("import and export report a missing folder"):
    val told = "expected a file in a folder that is there, got no/such/file"
    assertRefused(ExportCommand, Seq("x", "--mcap", "no/such/file"), s"skein export: --mcap: $told")
    assertRefused(ImportCommand, Seq("x", "--recording", "no/such/file"), s"skein import: --recording: $told")

  test("a file that cannot be written is reported with the reason in words"):
    val nowhere = Path.of("no", "such", "folder")
    assertEquals(
      OutFolder.write(nowhere, Seq(OutFolder.text("map.csv", ""))),
      Left(s"cannot write into $nowhere: no such file (${nowhere.resolve("map.csv")})")
    )

  test("a function for multirotors only refuses a scenario with cars, with the reason"):
    val cars = Seq("--scenario", "convoy")
    assertRefused(
      TortureCommand("skein.cli.Main"),
      cars,
      "--scenario convoy: expected multirotors, got cars"
    )
    assertRefused(
      FlyCommand(),
      cars :+ "--mavlink",
      "--mavlink: expected multirotors alone over MAVLink, got the car Lead"
    )
    assertRefused(
      FlyCommand(),
      Seq("--mavlink", "--loop", "paused"),
      "--mavlink: expected loops other than paused"
    )

  test("options of observe that have no effect with --bag are refused"):
    assertRefused(
      ObserveCommand,
      Seq("--bag", "walk.mcap", "--link", "vpn", "--seed", "2"),
      "skein observe: --bag: the bag is measured, and no program; got --link, --seed too"
    )
    assertRefused(
      ObserveCommand,
      Seq("--bag", "walk.mcap", "--ros", "--", "true"),
      "skein observe: --bag: the bag is measured, and no program; got --ros, a program too"
    )

  test("options of observe that have no effect with --ros are refused"):
    assertRefused(
      ObserveCommand,
      Seq("--ros", "--link", "vpn", "--listen", "127.0.0.1:0"),
      "skein observe: --ros: topics are measured, and no simulator's wire; got --listen, --link too"
    )
    assertRefused(
      ObserveCommand,
      Seq("--readings", "/a/odom"),
      "--readings: expected with --bag, --ros or --mavlink alone"
    )
    assertRefused(
      ObserveCommand,
      Seq("--commands", "/a/cmd_vel"),
      "--commands: expected with --bag or --ros alone"
    )
    assertRefused(
      ObserveCommand,
      Seq("--mavlink", "--readings", "POSITION"),
      "--readings: expected GLOBAL_POSITION_INT, LOCAL_POSITION_NED, ODOMETRY, ATTITUDE, ATTITUDE_QUATERNION, " +
        "got POSITION"
    )
    assertRefused(
      ObserveCommand,
      Seq("--simulator", "tcp://127.0.0.1:5760"),
      "--simulator: expected HOST:PORT"
    )
    assertRefused(
      ObserveCommand,
      Seq("--mavlink", "--simulator", "nosuch.invalid:14580"),
      "--simulator: the host nosuch.invalid is not known"
    )
    assertRefused(
      ObserveCommand,
      Seq("--listen", "0.0.0.0:41451"),
      "--listen: expected another address than the simulator's, got"
    )
    assertRefused(
      ObserveCommand,
      Seq("--mavlink", "--listen", "127.0.0.1:14580"),
      "--listen: expected another address than the simulator's, got 127.0.0.1:14580 twice"
    )

  test("options that only MAVLink uses are refused without it"):
    assertRefused(FlyCommand(), Seq("--simulator", "tcp://127.0.0.1:5760"), "tcp:// is for --mavlink alone")
    assertRefused(
      FlyCommand(),
      Seq("--mavlink", "--simulator", "tcp://127.0.0.1"),
      "expected HOST:PORT, for example 127.0.0.1:41451, got '127.0.0.1'"
    )
    assertRefused(
      FlyCommand(),
      Seq("--mavlink", "--loop", "stream", "--simulator", "127.0.0.1:5760", "--sensors", "position=1"),
      "--sensors: not together with --simulator over MAVLink"
    )
    assertRefused(ServeCommand, Seq("--mavlink-instance", "1"), "expected together with --mavlink")
    assertRefused(
      ServeCommand,
      Seq("--mavlink", "--mavlink-instance", "250"),
      "--mavlink-instance: expected 0 to 249, got 250"
    )

  test("an infinite tolerance is refused"):
    for value <- Seq("Infinity", "NaN", "0", "-1") do
      assertRefused(
        BudgetCommand("skein.cli.Main"),
        Seq("--within", value),
        "--within: expected a number above 0, got"
      )

  folder.test(
    "a configuration that is a folder, is missing, is nested too deeply or has unknown keys is refused"
  ): path =>
    def config(text: String) = Files.writeString(path.resolve("fly.conf"), text).toString
    assertRefused(FlyCommand(), Seq("--config", path.toString), "expected a file, got the folder")
    assertRefused(FlyCommand(), Seq("--config", path.resolve("none").toString), "there is no file")
    assertRefused(FlyCommand(), Seq("--config", config("a = " + "[" * 200_000)), "nested too deeply")
    assertRefused(FlyCommand(), Seq("--config", config("skein.fly.seedd = 1")), "the nearest is 'seed'")
    assertRefused(FlyCommand(), Seq("--config", config("duration = 5 s")), "no setting 'duration'")

  folder.test(
    "a mistake in a configuration is reported once, with its line, and long values are cut"
  ): path =>
    def told(text: String) =
      val file = Files.writeString(path.resolve("fly.conf"), text).toString
      val ran  = Ran.of(FlyCommand().run(Seq("--config", file, "--out", path.resolve("out").toString)))
      assertEquals(ran.status, 1)
      assert(Files.notExists(path.resolve("out")))
      ran.said.replace(file, "fly.conf")
    assertEquals(
      told("skein.fly { scenario = surround, surround { ring-m = null } }"),
      "skein fly: fly.conf: 1: skein.fly.surround.ring-m: expected a value, got null\n"
    )
    assertEquals(told("skein = 5").linesIterator.size, 1)
    assertEquals(told("skein.fly = [1]").linesIterator.size, 1)
    assertEquals(told("skein.fly.seed = ${nothing}").linesIterator.size, 1)
    for long <- Seq("seed = ", "loops = [", "scenario = ", "scene = ", "fallback = ") do
      val end  = if long.endsWith("[") then "]" else ""
      val said = told(s"skein.fly.$long${"x" * 10_000}$end")
      assert(clue(said).length < Complaint.MostOfALine && said.contains("letters more"), long)
      assertEquals(said.linesIterator.size, 1)
      val lines = told(s"skein.fly.$long\"\"\"a\nb\nc\"\"\"$end")
      assertEquals(lines.linesIterator.size, 1, lines)

  test("an option's long value is cut, and one with a line break is refused"):
    val long = Ran.of(FlyCommand().run(Seq("--loop", "x" * 10_000)))
    assert(clue(long.said).length < Complaint.MostOfALine)
    assertRefused(
      FlyCommand(),
      Seq("--out", "a\nb"),
      "skein fly: expected no line breaks or other control characters, got 'a\\u000ab'"
    )
    assertEquals(Complaint.text("a short line\nand another"), "a short line\nand another")
    val many = (1 to 40).map(number => s"mistake $number").toVector
    assertEquals(Complaint.text(many.take(12).mkString("\n")).linesIterator.toVector, many.take(12))
    val shown = Complaint.text(many.mkString("\n")).linesIterator.toVector
    assertEquals(shown, many.take(11) :+ "and 29 mistakes more")
    assertEquals(Complaint.text("y " * 2000).length, Complaint.MostOfALine + "… 3000 letters more …".length)

  folder.test("a folder that cannot contain recordings is refused in a line, and is not created"): path =>
    for name <- Seq("a\\b", "a?b", "a;b"); clock <- Seq("real", "virtual") do
      val out = path.resolve(name)
      val ran = Ran.of(FlyCommand().run(Seq("--out", out.toString, "--clock", clock)))
      assertEquals(ran.status, 1)
      assert(clue(ran.said).contains("expected a path without ';', '?' or '\\'"))
      assertEquals(ran.said.linesIterator.size, 1)
      assert(Files.notExists(out), name)

  folder.test("a policy with a number that is too large is refused"): path =>
    val file = Files.writeString(
      path.resolve("policy.conf"),
      "family = lead-pursuit\nparameters { turnRateRadPerS = 1e999, lead = 1, speedRatio = 0.5 }"
    )
    assertRefused(FlyCommand(), Seq("--policy", file.toString), "expected a finite number, got 'Infinity'")

  test("a simulator of infinite speed is refused"):
    for speed <- Seq("Infinity", "NaN", "0", "1e9") do
      assertRefused(ServeCommand, Seq("--speed", speed), "--speed: expected more than 0 and up to 1000, got")

  folder.test("a recording that cannot be read or written is reported in a line"): path =>
    val unreadable = Path.of("/proc/self/mem")
    if Files.isRegularFile(unreadable) then
      assertRefused(ReportCommand(), Seq(unreadable.toString), s"cannot open recording $unreadable")
    for clock <- Seq("real", "virtual") do
      assertRefused(
        FlyCommand(),
        Seq("--out", path.resolve("a;b").toString, "--clock", clock),
        "expected a path without ';', '?' or '\\'"
      )

  folder.test("a password in an unknown --record is not printed"): path =>
    for one <- Seq("Postgres://me:secret@db/flights", "postgres:me:secret@db", "mysql://db?password=secret")
    do
      val ran = Ran.of(FlyCommand().run(Seq("--record", one, "--out", path.resolve("flights").toString)))
      assert(ran.status != 0)
      assert(clue(ran.err).contains(s"got '${one.takeWhile(_ != ':')}:…'"))
      assert(!ran.said.contains("secret"))

  folder.test("an MCAP file that exists already is not overwritten, in virtual time neither"): path =>
    val file  = Files.writeString(path.resolve("stream-vpn.mcap"), "kept")
    val words = "--loop stream --link vpn --record mcap --clock".split(' ').toSeq
    for clock <- Seq("virtual", "real") do
      assertRefused(FlyCommand(), words ++ Seq(clock, "--out", path.toString), s"$file exists already")
    assertEquals(Files.readString(file), "kept")

  folder.test("loops, wire and vehicle of a configuration may come from references and the environment"):
    path =>
      def loops(text: String, words: String*) =
        val file = Files.writeString(path.resolve("fly.conf"), text).toString
        ParserForClass[FlightOptions]
          .constructOrThrow(words ++ Seq("--config", file))
          .settings
          .map(_.loops.map(_.label))
      val others = List("sequential", "futures", "stream", "predictive")
      val all    = "paused" :: others
      assertEquals(loops("skein.fly.wire = mav${?NO_SUCH}link"), Right(others))
      assertEquals(
        loops("skein.fly { only = ${?NO_SUCH}, wire = ${?NO_SUCH}, loops = ${?NO_SUCH} }"),
        Right(all)
      )
      assertEquals(loops("skein.fly.loops = ${?NO_SUCH}", "--mavlink"), Right(others))
      assertEquals(loops("skein.fly.loops = ${skein.fly.loops} [plan]"), Right(all :+ "plan"))

  folder.test("a recording without vehicles is not replayed"): path =>
    val heading  = skein.report.SyntheticFlight("stream", "vpn", seed = 1, seconds = 12).heading
    val recorder = MemoryRecorder(heading.copy(vehicles = Nil))
    val file     = path.resolve("none.duckdb")
    assert(recorder.writeTo(file).isRight)
    assertRefused(ReplayCommand(), Seq(file.toString), "no vehicles")

  test("spread lists no options that it refuses always"):
    val listed = SpreadCommand("skein.cli.Main").options.map(_.flag)
    assert(listed.contains("--between"))
    assertEquals(listed.filter(Set("--only", "--images")), Seq.empty)

  test("an impossible solver is reported before the flight, with what was expected"):
    val virtual = Seq("--clock", "virtual")
    val alone   = Seq("--decentralised", "--only", "Pursuer", "--loop", "stream")
    for
      (command, words, expected) <- Seq(
        (FlyCommand(), Seq("--solver", "pekko://127.0.0.1:1"), "not Pekko's remoting"),
        (
          FlyCommand(),
          Seq("--solver", "tcp://127.0.0.1"),
          "expected tcp://HOST:PORT, kafka://HOST:PORT/PREFIX or link"
        ),
        (FlyCommand(), Seq("--solver", "kafka://127.0.0.1:9092/a b"), "expected a PREFIX of topics"),
        (FlyCommand(), Seq("--solver", "link:vpn"), "--solver link:vpn is for --clock virtual"),
        (
          FlyCommand(),
          virtual ++ Seq("--solver", "tcp://127.0.0.1:7400"),
          "in virtual time expected link:PROFILE"
        ),
        (FlyCommand(), virtual ++ Seq("--solver", "link:vpm"), "vpm"),
        (FlyCommand(), virtual ++ Seq("--twins", "2"), "not together with --clock virtual"),
        (FlyCommand(), virtual ++ alone, "--only: expected with --simulator"),
        (SpreadCommand("skein.cli.Main"), alone, "--only: expected with fly alone"),
        (FlyCommand(), Seq("--decentralised", "--knows", "all"), "--decentralised: expected knows positions"),
        (
          FlyCommand(),
          virtual ++ Seq("--solver", "link:vpn", "--loop", "paused"),
          "got with paused alone"
        ),
        (
          FlyCommand(),
          virtual ++ Seq("--solver", "link:vpn", "--loop", "plan", "--deadline", "50ms"),
          "deadline: expected more than planning.deadline, for which a " +
            "solver searches its plans, 60.0 ms; got 50.0 ms"
        ),
        (
          FlyCommand(),
          virtual ++ Seq("--solver", "link:vpn", "--loop", "plan", "--period", "50ms"),
          "period: expected more than planning.deadline"
        ),
        (
          SpreadCommand("skein.cli.Main"),
          Seq("--solver", "tcp://127.0.0.1:7400"),
          "in virtual time expected link:PROFILE"
        ),
        (DecideCommand(), Seq("--at", "tcp://10.0.0.1:7400"), "--tls: expected certificates of both sides"),
        (FlyCommand(), Seq("--solver", "tcp://10.0.0.1:7400"), "--tls: expected certificates of both sides"),
        (FlyCommand(), Seq("--tls", "certificates"), "--tls, --kafka-security: expected with a solver"),
        (DecideCommand(), Seq("--at", "link:vpn"), "expected tcp://HOST:PORT"),
        (
          DecideCommand(),
          Seq("--at", "kafka://10.0.0.1:9092/skein"),
          "--tls: expected certificates where the Kafka broker at 10.0.0.1:9092 is of another machine"
        ),
        (DecideCommand(), Seq("--scenario", "moon"), "--scenario: ")
      )
    do assertRefused(command, words, expected)
