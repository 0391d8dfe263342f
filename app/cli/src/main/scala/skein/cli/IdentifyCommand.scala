package skein.cli

import java.nio.file.Path
import mainargs.{Flag, Leftover, ParserForClass, arg}
import skein.forecast.Structure
import skein.figures.ResponseFigure
import skein.identify.*
import skein.measure.{FlownVehicle, FlownVehicles, NoResult, RecordedSeeing}
import skein.units.OwnFailure
import skein.record.{Digest, Recording, RecordingReader}
import skein.report.{Section, TextTable, Typed}
import skein.scenario.{PaperDuel, Scenarios}
import skein.settings.{Fit, ModelFile, SensorFile}
import skein.units.Decimals.fixed
import skein.units.{Expect, Interval, Span}

/** Command-line options of `./skein identify`, with their help texts. */
final case class IdentifyOptions(
    @arg(doc = "recordings, for example flights/*.duckdb")
    files: Leftover[String],
    @arg(doc = "a vehicle to fit a model to; can be repeated; without it, all")
    vehicle: Seq[String],
    @arg(doc =
      "the model that model.conf selects: lag, turn, drag, drag-and-turn, or one of your program's own; " +
        "all are fitted"
    )
    structure: String = Structure.Drag.label,
    @arg(doc = "how far each reading is predicted for the fit")
    horizon: String = "2s",
    @arg(doc =
      "folder for model.conf, model.svg, model.png and sensor.conf; without it, that of the first recording"
    )
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein identify`: fits models of vehicles and of a sensor to recordings. */
final class IdentifyCommand(using scenarios: Scenarios)
    extends Command[IdentifyOptions](
      "identify",
      "fits models of vehicles, and of what their cameras recognise, to recordings",
      ParserForClass[IdentifyOptions]
    ):

  /** Maximum number of a figure's panels; a figure with more is omitted. */
  private val MostPanels = 16

  protected def execute(options: IdentifyOptions): Either[String, Unit] =
    for
      files <- Either.cond(
        options.files.value.nonEmpty,
        options.files.value.toVector,
        "expected recordings, got none: ./skein identify FILE…"
      )
      out <-
        OutFolder.made("--out", options.out.getOrElse(OutFolder.of(Path.of(files.head))))
      use     <- scenarios.structure(options.structure).left.map("--structure: " + _)
      horizon <- Span.parse(options.horizon).left.map("--horizon: " + _)
      _       <- Expect.that(horizon.toSeconds >= 0.2):
        s"--horizon: expected 200ms or more, got ${options.horizon}"
      recordings <- read(files)
      _          <- once(files)
      vehicles   <- IdentifiedVehicles.chosen(recordings.flatMap(FlownVehicles.of), options.vehicle)(
        Console.err.println
      )
      flights = vehicles.flatMap(_.stretches)
      fits <- fit(vehicles, use, horizon.toSeconds)
      shown    = Shown(options.json.value)
      sensor   = sensorOf(recordings)
      sections = tables(fits, flights) ++ sensor.map(sensorTable)
      _        = shown.say(clocks(recordings))
      _        = shown.tables(sections, Section.text(sections))
      from     = ModelFile.Provenance(
        files.zip(recordings).map(described),
        flights.map(_.name).distinct,
        horizon.toSeconds,
        version(recordings),
        IdentifiedVehicles.altitudeM(vehicles)
      )
      paths <- write(
        out,
        ModelFile.render(use, fits, from),
        fits.find(_.identification.structure == use).get,
        flights,
        sensor.map(SensorFile.render(_, files.zip(recordings).map(described)))
      )
    yield shown.say(
      s"\nwritten: ${paths.mkString(", ")}\n${flyBy(use, out.resolve("model.conf"), vehicles)}" +
        sensor.fold("")(_ => s"\nuse it: ./skein budget --eye ${out.resolve("sensor.conf")}")
    )

  private def read(files: Vector[String]): Either[String, Vector[Recording]] =
    Expect.each(files): file =>
      for
        recording <- RecordingReader.read(Path.of(file)).left.map(_.message)
        _ <- NoResult.of(recording).map(none => s"$file: no result: ${none.what}: ${none.why}").toLeft(())
      yield recording

  /** Refuses recordings given twice: they would make the intervals too narrow. */
  private def once(files: Vector[String]): Either[String, Unit] =
    if files.sizeIs < 2 then Right(())
    else
      for
        digests <- Expect.each(files)(file => Digest.ofFile(Path.of(file)).left.map(_.message))
        same = files.zip(digests).groupMap(_._2)(_._1).values.find(_.sizeIs > 1)
        _ <- Expect.that(same.isEmpty):
          s"expected every flight once, got the same one in ${same.get.mkString(" and ")}"
      yield ()

  private def fit(
      vehicles: Vector[FlownVehicle],
      use: Structure,
      horizonS: Double
  ): Either[String, Vector[Fit]] =
    val structures = scenarios.structures
    val flights    = vehicles.flatMap(_.stretches)
    val notOurs    = IdentifiedVehicles.unlike(vehicles)
    val reflown    =
      if Structure.ours.contains(use) && notOurs.isEmpty then flights.map(HorizonErrors.reflown(_))
      else Vector.empty
    Expect
      .each(structures.zipWithIndex): (structure, index) =>
        notOurs.filter(_ => Structure.ours.contains(structure)).toLeft(()).flatMap(_ =>
          identified(flights, structure, horizonS)
        ) match
          case Right(found) =>
            val unsettled =
              if found.isConverged then "" else ", not converged: its parameters are where the fit stopped"
            Console.err.println(s"fitted ${structure.label}: ${index + 1} of ${structures.size}$unsettled")
            Right(Some(Fit(
              found,
              HorizonErrors.of(found.plant, reflown),
              HorizonErrors.of(found.plant, flights)
            )))
          case Left(reason) if structure != use =>
            Console.err.println(s"${structure.label} is not fitted: $reason")
            Right(None)
          case Left(reason) => Left(reason)
      .map(_.flatten)

  /** Fits a structure; an exception of a user's plant becomes the reason why it has no fit. */
  private def identified(
      flights: Vector[TimeHistory],
      structure: Structure,
      horizonS: Double
  ): Either[String, Identification] =
    def found = Identification.of(flights, structure, horizonS)
    if Structure.ours.contains(structure) then found
    else
      try OwnFailure.told("its plant")(found)
      catch case failed: OwnFailure => Left(failed.getMessage)

  /** Fits the model of the flights' sensor, if they had one with enough detections. */
  private def sensorOf(recordings: Vector[Recording]): Option[SensorFit] =
    val seeing = recordings.flatMap(RecordedSeeing.of)
    Option.when(seeing.nonEmpty)(SensorFit.of(seeing)).flatMap: fit =>
      fit.left.foreach(reason => Console.err.println(s"no sensor is fitted: $reason"))
      fit.toOption

  private def sensorTable(fit: SensorFit): Section =
    val takes = fit.model.takes
    Section(
      f"What saw: ${fit.detections} detections in ${fit.images} images, up to ${fit.model.farthestM}%.1f m; recognition took ${takes.quantile(0.5).toMillis}%.0f ms at the median, ${takes.quantile(0.99).toMillis}%.0f at 99 %%",
      table = Some(TextTable(fit.fitted.map(_.name), Vector(fit.fitted.map(interval))))
    )

  private def described(file: String, recording: Recording): String =
    val flight = recording.flight
    s"${Path.of(file).getFileName}: ${flight.id}, seed ${flight.seed}, ${flight.clock} clock, simulator ${flight.simulator.label}"

  /** Notes which flights were virtual: these use only the built-in simulator and should not be mixed with
    * fits to another.
    */
  private def clocks(recordings: Vector[Recording]): String =
    val byClock = recordings.groupBy(_.flight.clock).toVector.sortBy(_._1)
    byClock.map((clock, flown) => s"${flown.size} on the $clock clock").mkString("recordings: ", ", ", "")

  /** A line on how to use the model file: with this program, if only it knows the structure. */
  private def flyBy(use: Structure, file: Path, vehicles: Vector[FlownVehicle]): String =
    val named = Typed.path(file)
    if Structure.ours.contains(use) then
      s"use it: ./skein fly --loop predictive --predictor $named${elsewhere(vehicles)}"
    else s"use it, with this program: fly --loop predictive --predictor $named, search --plant $named"

  /** A line on the altitude of flights with this model, if the vehicles did not fly at the duel's altitude.
    */
  private def elsewhere(vehicles: Vector[FlownVehicle]): String =
    IdentifiedVehicles.altitudeM(vehicles).filter(_ != PaperDuel.AltitudeM).fold("")(metres =>
      s" --altitude ${(metres * 10).round / 10.0}"
    )

  private def version(recordings: Vector[Recording]): String =
    recordings.map(_.flight.version).distinct.mkString(", ")

  private def tables(fits: Vector[Fit], flights: Vector[TimeHistory]): Vector[Section] =
    val names      = (Structure.DragAndTurn.names ++ fits.flatMap(_.identification.structure.names)).distinct
    val parameters = fits.map: fit =>
      val found = fit.identification
      (found.structure.label + (if found.isConverged then "" else " (not converged)")) +: names.map(name =>
        found.parameters.find(_.name == name).fold("")(interval)
      ) ++:
        Vector(f"${found.velocityRmsMps}%.4f", f"${found.positionRmsM}%.4f")
    val seconds = flights.map(_.spanS).sum
    val first   = fits.head.identification
    Vector(
      Section(
        f"${flights.map(_.name).distinct.size} flights of one vehicle, $seconds%.0f s, ${first.predictions} predicted readings; ± is the 95 %% interval over ${first.blocks} blocks",
        table = Some(TextTable(("<structure" +: names) ++ Vector("rms m/s", "rms m"), parameters))
      )
    ) ++ Option.when(fits.exists(_.againstQuadrotor.nonEmpty))(
      Section(
        "Off the full quadrotor under the same commands, half and 95 % of the predictions at most",
        table = Some(horizons(fits, _.againstQuadrotor))
      )
    ) :+ Section("Off the readings", table = Some(horizons(fits, _.againstReadings)))

  private def interval(fitted: Fitted): String =
    val text = Interval.of(fitted.value, (fitted.most - fitted.least) / 2).text
    if fitted.atBound then s"$text (bound)" else text

  private def horizons(fits: Vector[Fit], errors: Fit => Vector[HorizonError]): TextTable =
    TextTable.of(fits.flatMap(fit => errors(fit).map((fit.identification.structure.label, _))))(
      "<structure"       -> (_._1),
      "horizon s"        -> (_._2.horizonS.fixed(0)),
      "predictions"      -> (_._2.predictions.toString),
      "position p50 m"   -> (_._2.positionP50M.fixed(3)),
      "p95 m"            -> (_._2.positionP95M.fixed(3)),
      "velocity p50 m/s" -> (_._2.velocityP50Mps.fixed(3)),
      "p95 m/s"          -> (_._2.velocityP95Mps.fixed(3))
    )

  private def write(
      out: Path,
      model: String,
      fit: Fit,
      flights: Vector[TimeHistory],
      sensor: Option[String]
  ): Either[String, Vector[Path]] =
    val drawing     = ResponseFigure(fit.identification.plant, flights.take(MostPanels))
    val description = "Measured and modelled velocity over time, and residuals"
    OutFolder.write(
      out,
      Vector(OutFolder.text("model.conf", model)) ++ sensor.map(OutFolder.text(
        "sensor.conf",
        _
      )) ++ OutFolder.picture("model", drawing, description, scale = 2)
    )
