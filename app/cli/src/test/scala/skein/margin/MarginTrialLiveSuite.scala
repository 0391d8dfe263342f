package skein.margin

import org.apache.pekko.actor.ActorSystem
import skein.airsim.{Vehicles, WorldSettings}
import skein.scenario.PaperDuel
import skein.scene.Scene
import skein.signal.LatencyProfile
import skein.testing.Waiting
import skein.units.*

/** Programs are processes of this machine's shell; real sockets and the real clock. */
class MarginTrialLiveSuite extends munit.FunSuite, Waiting:
  private given system: ActorSystem = ActorSystem("margin-trial")

  override def afterAll(): Unit = system.terminate(): Unit

  private val duel     = PaperDuel()
  private val vehicles = duel.agents.map(Vehicles.settings)

  /** The run of a script, and its output. */
  private def run(script: String, seconds: Double, isStopped: Boolean = false) =
    val task = MarginTask(
      Seq("bash", "-c", script),
      WorldSettings.of(vehicles),
      Scene.Empty,
      Some(duel),
      MarginJudge.Contacts,
      Span.ofSeconds(seconds),
      Span.Zero
    )
    MarginTrial(task, Clock.system).run(LatencyProfile.none, 1, () => isStopped).fold(fail(_), identity)

  private def why(run: MarginRun) = run.value.left.toOption.map(_.why)

  private val connect = "exec 3<>/dev/tcp/127.0.0.1/{port}"

  /** [0, 1, "hover", [""]] */
  private val hover = """printf '\x94\x00\x01\xa5hover\x91\xa0' >&3; head -c 5 <&3 >&2"""

  test("a program receives the port in its arguments and its environment, and its output is kept"):
    val ended = run("echo $(({port} - SKEIN_PORT))", 60)
    assertEquals(ended.printed.trim, "0")
    assert(why(ended.run).exists(_.startsWith("it never connected")), ended.run)

  test("a program that connects, commands nothing and does not end is stopped when its time has elapsed"):
    assertEquals(why(run(s"$connect; sleep 1000", 2).run), Some("it connected, and commanded nothing"))

  test("a run that must stop before its time is marked as cut short, also if its program has ended"):
    assert(run("sleep 1000", 60, isStopped = true).isCut)
    assert(run("exit 130", 60, isStopped = true).isCut)
    assert(!run("exit 0", 60).isCut)

  test("a program is scored from its first command on"):
    val ended = run(s"$connect; $hover; sleep 0.5", 60).run
    // A busy machine spoils a run, which is reported.
    assume(ended.value.left.forall(!_.why.contains("too busy")), "inconclusive")
    assertEquals(ended.value, Right(0.0))

  test("a program that dies is reported with its last line, even after commands"):
    val told = why(run(s"$connect; $hover; echo 'no battery' >&2; exit 3", 60).run).getOrElse("")
    assert(told.startsWith("it ended with exit status 3 after ") && told.endsWith("no battery"), told)

  test("a missing program is reported in a line"):
    val task = MarginTask(
      Seq("no-such-program"),
      WorldSettings.Default,
      Scene.Empty,
      None,
      MarginJudge.Printed,
      Span.ofSeconds(1),
      Span.Zero
    )
    val told = MarginTrial(task, Clock.system).run(LatencyProfile.none, 1, () => false).left.toOption
    assert(told.exists(_.startsWith("cannot start no-such-program")), told)
