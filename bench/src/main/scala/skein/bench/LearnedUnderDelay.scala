package skein.bench

import java.nio.file.{Files, Path}
import mainargs.ParserForClass
import skein.cli.{LearnCommand, LearnOptions, Main}
import skein.optimise.RunningStats
import skein.plot.*
import skein.policy.{PolicyFamily, Role}
import skein.scenario.Scenarios
import skein.search.Judge
import skein.settings.PolicyFile
import skein.training.*

/** Is a policy trained under a link's timing better over that link, or does training on the paused simulator
  * suffice? One learner trains two policies of each side, on the paused simulator and under `stream` over
  * `vpn`; both are run over `vpn` under `stream` and `predictive` in virtual time, and on the paused
  * simulator, compared with the paper's policy and the best that a search finds: `./skein search --family
  * lead-pursuit --link vpn`, and `--family chauffeur-evader`. Run: `./sbtw "bench/runMain
  * skein.bench.LearnedUnderDelay learned/under-delay 100 evader 2"`, for one side and a seed; results that
  * are in the folder already are continued. The picture is written there, too.
  */
object LearnedUnderDelay:
  private given Scenarios = Main.scenarios

  private val flown = Vector("paused" -> "none", "stream" -> "vpn", "predictive" -> "vpn")

  /** @param captures number of flights in which the pursuer came within [[CaptureM]] of the evader */
  private[bench] final case class Row(
      policy: String,
      loop: String,
      link: String,
      distance: RunningStats,
      captures: Int
  )

  private val CaptureM = 1.5

  def main(args: Array[String]): Unit =
    val folder  = Path.of(args.headOption.getOrElse("learned/under-delay"))
    val flights = args.lift(1).fold(100)(_.toInt)
    val sides   = args.lift(2).fold(Seq("pursuer", "evader"))(Seq(_))
    val seed    = args.lift(3).getOrElse("1")
    val panels  = sides.map: side =>
      val rows = flownBy(side, folder, flights, seed)
      println(
        s"| $side | loop | link | distance over the last 10 s, m: mean ± " +
          s"sd | ± 95 % | nearer than $CaptureM m in | flights |"
      )
      println("|---|---|---|---|---|---|---|")
      for row <- rows do
        val half = row.distance.halfWidth95
        println(
          f"| ${row.policy} | `${row.loop}` | ${row.link} | ${row.distance.mean}%.2f ± " +
            f"${row.distance.sd}%.2f | ± $half%.3f | ${row.captures} | ${row.distance.count} |"
        )
      picture(side, rows)
    Png.bytes(Drawing.stacked(panels*), 2) match
      case Right(bytes) => println(s"wrote ${Files.write(folder.resolve("learned-under-delay.png"), bytes)}")
      case Left(reason) => println(s"no picture: $reason")

  private def flownBy(side: String, folder: Path, flights: Int, seed: String): Vector[Row] =
    val taught = Vector("paused" -> "none", "stream" -> "vpn").map: (loop, link) =>
      s"trained ${timing(loop, link)}" -> learned(
        folder.resolve(s"$side-$loop-$link"),
        question(side, loop, link, seed)
      )
    val role     = PolicyFile.role(side).fold(sys.error, identity)
    val searched =
      if role == Role.Pursuer then
        "the best of lead-pursuit" -> PolicyFile(
          role,
          PolicyFamily.leadPursuit,
          Vector(0.5453, 0.7326, 2.996)
        )
      else
        "the best of chauffeur-evader" -> PolicyFile(
          role,
          PolicyFamily.chauffeurEvader,
          Vector(1.528, 0.3126, 6.317)
        )
    val policies = ("the paper's" -> PolicyFile.paperOf(role)) +: searched +: taught
    for
      (loop, link)   <- flown
      (name, policy) <- policies
    yield
      val flown = question(side, loop, link, seed).setup
        .flatMap(LearnCommand.summaries(_, policy, if loop == "paused" then 1 else flights))
        .fold(sys.error, identity)
        .flatMap(_.distance)
      val distances = flown.flatMap(_.lastTenSeconds).map(_.mean)
      Row(
        name,
        loop,
        link,
        RunningStats.of(distances.size)(distances),
        flown.count(_.closest._2 <= CaptureM)
      )

  private def question(side: String, loop: String, link: String, seed: String): LearnQuestion =
    LearnCommand
      .question(
        ParserForClass[LearnOptions].constructOrThrow(
          Seq("--side", side, "--loop", loop, "--link", link, "--seed", seed)
        )
      )
      .fold(sys.error, identity)

  /** Learns a policy, or continues what the folder contains. */
  private def learned(folder: Path, wanted: LearnQuestion): PolicyFile =
    Files.createDirectories(folder): Unit
    val (asked, from) = LearnFile.read(folder) match
      case Right(file) => (file.question, file.state)
      case Left(_)     => (wanted, LearnState())
    val setup = asked.setup.fold(sys.error, identity)
    val cpu   = ProcessHandle.current.info.totalCpuDuration
    val state = LearnRun(setup, setup.judges(2)(Judge.Candidates), Some(folder), () => System.nanoTime())
      .run(from, 2, () => false)(state =>
        if state.rounds % 10 == 0 then
          Console.err.println(
            s"$folder: ${state.rounds} of ${setup.rounds} rounds, best ${state.best.fold(0.0)(_.mean)} m"
          )
      )
      .flatMap(_.unfailing)
      .fold(sys.error, identity)
    Console.err.println(s"processor time before $cpu, now ${ProcessHandle.current.info.totalCpuDuration}")
    setup.policy(state.best.get.weights)

  private val colours = Vector(Colour(0x111111), Colour(0x009e73), Colour(0xd55e00), Colour(0x0072b2))

  /** The timing under which a policy is trained or run. */
  private def timing(loop: String, link: String) =
    if loop == "paused" then "on the paused simulator" else s"under $loop over $link"

  /** A row per loop and policy: the mean as a disc, a standard deviation to either side. */
  private[bench] def picture(side: String, rows: Vector[Row]): Drawing =
    val most   = rows.map(row => row.distance.mean + row.distance.sd).max
    val height = 20.0 * rows.size
    val panel  = Panel(
      PlotAxis.around("distance over the last 10 s, m", 0, most),
      PlotAxis.exactly("", 0, rows.size.toDouble, 1).copy(ticks = Vector.empty),
      left = 400,
      top = 34,
      width = 460,
      height
    )
    val names = rows.map(_.policy).distinct
    val marks = rows.zipWithIndex.flatMap: (row, index) =>
      val y                = panel.top + 20 * (index + 0.5)
      val colour           = colours(names.indexOf(row.policy))
      val (at, sd)         = (row.distance.mean, row.distance.sd)
      def x(value: Double) = panel.atX(value.max(0))
      Vector(
        Mark.Text(
          Point(panel.left - 10, y + 4),
          s"flown ${timing(row.loop, row.link)}: ${row.policy}",
          Theme.labelSize,
          Theme.labelColour,
          Anchor.End
        ),
        Mark.line(Point(x(at - sd), y), Point(x(at + sd), y), Stroke(colour, 3)),
        Mark.Disc(Point(x(at), y), 4, Some(Stroke(Colour(0xffffff), 0.8)), Some(colour))
      )
    Drawing(
      panel.right + 40,
      panel.bottom + 44,
      (panel.title(s"The $side, flown in virtual time") +: panel.axes) ++ marks
    )
