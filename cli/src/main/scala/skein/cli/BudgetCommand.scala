package skein.cli

import java.io.IOException
import java.nio.file.{Files, Path}
import mainargs.{Flag, ParserForClass, arg}
import skein.budget.*
import skein.optimise.Objective
import skein.plot.{Png, Svg}
import skein.policy.PolicyFamily
import skein.record.LoopKind
import skein.search.Conditions
import skein.settings.PolicyFile
import skein.signal.LatencyDistribution
import skein.units.Span

/** Options of `./skein budget`. */
final case class BudgetOptions(
    @arg(doc = "a policy file, or the name of a family (default: paper-pursuer)")
    policy: Option[String],
    forward: ForwardOptions,
    @arg(doc = "between decisions for one vehicle; several give a map each (default: 100ms)")
    period: Seq[String],
    @arg(name = "most-mean", doc = "mean latency at which the map ends (default: 200ms)")
    mostMean: Option[String],
    @arg(name = "most-jitter", doc = "jitter at which the map ends (default: 100ms)")
    mostJitter: Option[String],
    @arg(doc = "cells along the latency")
    means: Int = 40,
    @arg(doc = "cells along the jitter")
    jitters: Int = 20,
    @arg(doc = "of each cell (default: 1000 with a reduced model by SIMD, fewer where an episode costs more)")
    episodes: Option[Int],
    @arg(doc = "share of the truth that counts as holding, in per cent")
    tolerance: Double = 5,
    @arg(name = "at-jitter", doc = "jitter of which the sentence speaks (default: 20ms)")
    atJitter: Option[String],
    @arg(name = "one-way", doc = "all latencies are of one direction, instead of round trips")
    oneWay: Flag,
    @arg(doc = "folder for map.svg, map.png, map.csv and map.json")
    out: String = "budget",
    @arg(doc = "the map as JSON on standard output, as in map.json; all else goes to the error output")
    json: Flag
)

object BudgetCommand
    extends OptionsCommand[BudgetOptions](
      "budget",
      "tells how much latency and jitter a policy bears, and draws the map",
      ParserForClass[BudgetOptions]
    ):
  private val MostCells    = 10_000
  private val MostEpisodes = 100_000

  protected def execute(options: BudgetOptions): Either[String, Unit] =
    for
      threads   <- options.forward.threadCount
      policy    <- policyOf(options.policy.getOrElse("paper-pursuer")).left.map("--policy: " + _)
      other     <- options.forward.opponentOf(policy.role)
      objective <- Objective
        .parse(options.forward.objective.getOrElse("last10s"), policy.role)
        .left
        .map("--objective: " + _)
      legs = if options.oneWay.value then Legs.OneWay else Legs.RoundTrip
      axes       <- axesOf(options, legs)
      atJitterMs <- milliseconds("--at-jitter", options.atJitter, 20, legs)
      _          <- Either.cond(
        options.tolerance > 0 && options.tolerance <= 1000,
        (),
        s"--tolerance: expected more than 0 %, came ${options.tolerance}"
      )
      _ <- Either.cond(
        options.episodes.forall(count => count >= 1 && count <= MostEpisodes),
        (),
        s"--episodes: expected 1 to $MostEpisodes, came ${options.episodes.getOrElse(0)}"
      )
      flown  <- conditions(options)
      folder <- OutFolder.made("--out", options.out)
      maps   <- fly(options, flown, policy, other, objective, axes, legs, threads)
      files  <- write(maps, folder)
    yield
      val shown = Shown(options.json.value)
      if options.json.value then Console.out.println(BudgetMap.json(maps))
      for map <- maps do
        shown.say(s"${policy.label}: ${map.sentence(atJitterMs)}")
        map.markLines.foreach(line => shown.say(s"  $line"))
      shown.say(s"written: ${files.mkString(", ")}")

  private def policyOf(text: String): Either[String, PolicyFile] =
    PolicyFamily.parse(text).toOption match
      case Some(family) => PolicyFile.roleOf(family, None).map(PolicyFile.ofDefaults(_, family))
      case None         => PolicyFile.read(text)

  private def milliseconds(option: String, text: Option[String], otherwise: Double, legs: Legs) =
    text
      .fold(Right(Span.ofMillis(otherwise)))(Span.parse)
      .map(_.toMillis * legs.perRoundTrip)
      .left
      .map(mistake => s"$option: $mistake")

  private def axesOf(options: BudgetOptions, legs: Legs): Either[String, BudgetAxes] =
    for
      mean   <- milliseconds("--most-mean", options.mostMean, 200 / legs.perRoundTrip, legs)
      jitter <- milliseconds("--most-jitter", options.mostJitter, 100 / legs.perRoundTrip, legs)
      _      <- Either.cond(
        options.means >= 2 && options.jitters >= 2 && options.means.toLong * options.jitters <= MostCells,
        (),
        s"--means, --jitters: expected 2 or more each and at most $MostCells cells, came ${options.means} and ${options.jitters}"
      )
      _ <- Either.cond(
        mean > 0 && mean <= 500 && jitter > 0 && jitter <= 500,
        (),
        s"--most-mean, --most-jitter: expected round trips of more than 0 and up to 500 ms, came $mean and $jitter ms"
      )
    yield BudgetAxes.of(mean, options.means, jitter, options.jitters)

  private def conditions(options: BudgetOptions): Either[String, Vector[(Conditions, Conditions.Resolved)]] =
    val periods = if options.period.isEmpty then Vector("100ms") else options.period.toVector
    periods.foldLeft[Either[String, Vector[(Conditions, Conditions.Resolved)]]](Right(Vector.empty)):
      (before, text) =>
        for
          read     <- before
          period   <- Span.parse(text).left.map("--period: " + _)
          named    <- options.forward.conditions(period)
          resolved <- named.resolved
          _        <- Either.cond(
            named.loop != LoopKind.Paused.label,
            (),
            "--loop: the paused loop is the truth and feels no latency; expected sequential, futures, stream or predictive"
          )
        yield read :+ (named, resolved)

  private def fly(
      options: BudgetOptions,
      flown: Vector[(Conditions, Conditions.Resolved)],
      policy: PolicyFile,
      opponent: PolicyFile,
      objective: Objective,
      axes: BudgetAxes,
      legs: Legs,
      threads: Int
  ): Either[String, Vector[BudgetMap]] =
    val shown             = Shown(options.json.value)
    @volatile var stopped = false
    Edge.untilInterrupted(() => stopped = true):
      flown.foldLeft[Either[String, Vector[BudgetMap]]](Right(Vector.empty)): (before, asked) =>
        val (named, resolved) = asked
        val sweep             = BudgetSweep(
          resolved,
          policy,
          opponent,
          objective,
          axes,
          options.episodes,
          options.forward.seed.getOrElse(1),
          threads
        )
        def map(): Either[String, BudgetMap] =
          shown.say(
            s"${named.loop} every ${PolicyFile.brief(named.periodMs)} ms, ${resolved.vehicle.description}\n" +
              s"${sweep.episodes} episodes of ${PolicyFile.brief(named.durationS)} s in each of ${sweep.expected / sweep.episodes} cells; engine: ${sweep.engine}"
          )
          val startedAt = System.nanoTime()
          val line      = ProgressLine(sweep.expected, Console.err)
          val truth     = sweep.truth
          for
            _ <- Either.cond(
              truth != 0 && truth.isFinite,
              (),
              s"--objective: ${objective.formula} of the paused truth is $truth, so no share of it can be told; choose another"
            )
            budget <- sweep.map(
              done => line.show(done, ""),
              () => stopped
            ).toRight("stopped before the map was whole")
          yield
            line.end()
            val seconds = (System.nanoTime() - startedAt) * 1e-9
            shown.say(f"${sweep.expected}%,d episodes in $seconds%.1f s")
            BudgetMap(
              named.loop,
              named.periodMs,
              objective.formula,
              objective.unit,
              resolved.vehicle.description,
              policy.label,
              options.tolerance / 100,
              sweep.episodes,
              budget,
              Vector("direct" -> LatencyDistribution.Direct, "vpn" -> LatencyDistribution.Vpn).map:
                (name, roundTrip) => BudgetMark(name, roundTrip, sweep.over(roundTrip))
              ,
              legs
            )
        before.flatMap(maps => map().map(maps :+ _))

  private def write(maps: Vector[BudgetMap], folder: Path): Either[String, Vector[Path]] =
    val drawing                 = BudgetFigure(maps)
    val painted                 = Png.bytes(drawing)
    def file(extension: String) = folder.resolve(s"map.$extension")
    val contents                = Vector(
      file("svg") -> Svg.file(drawing, "latency budget").getBytes("UTF-8"),
      file("csv") -> (BudgetMap.CsvHeader +: maps.flatMap(_.csvRows)).mkString(
        "",
        "\n",
        "\n"
      ).getBytes("UTF-8"),
      file("json") -> BudgetMap.json(maps).getBytes("UTF-8")
    ) ++ painted.toOption.map(file("png") -> _)
    try
      for (path, bytes) <- contents do Files.write(path, bytes)
      painted.left.foreach(reason => Console.err.println(s"no PNG: $reason"))
      Right(contents.map(_._1))
    catch case failed: IOException => Left(s"--out: cannot write into $folder: ${failed.getMessage}")
