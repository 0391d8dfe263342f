package skein.report

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.{Try, Using}
import skein.figures.Figure
import skein.flight.InParallel
import skein.measure.{FlightSet, FlightSummary}
import skein.plot.{Png, Svg}
import skein.record.{FileReason, RecordError, Recording, RecordingReader}
import skein.scenario.Scenarios
import skein.settings.FlightPlan
import skein.units.Expect

/** Turns recordings into tables and pictures; needs only the recordings. */
object Report:

  /** Summarises recordings, each flight once. Tries all, and lists every unreadable one. Blocks. */
  def read(files: Seq[Path])(using Scenarios): Either[Seq[RecordError], FlightSet] =
    readOnce(files).map(_.flights)

  /** Summarises recordings like `read`, and lists duplicate files: named twice, or copies. A flight that
    * counted twice would make spreads too narrow.
    */
  def readOnce(files: Seq[Path])(using
      Scenarios
  ): Either[Seq[RecordError], (flights: FlightSet, twice: Vector[String])] =
    val named          = files.groupBy(real)
    val once           = files.distinctBy(real)
    val (unread, read) =
      onAllCores(once)(file => RecordingReader.read(file).map(file -> _)).partitionMap(identity)
    val flown = read.distinctBy(_._2)
    val again =
      named.values.filter(_.sizeIs > 1).map(_.head).toVector.sorted.map(file => s"$file is named twice")
    val copies = (read diff flown).map: (file, recording) =>
      s"$file is the same flight as ${flown.find(_._2 == recording).fold("another")(_._1.toString)}"
    Either.cond(unread.isEmpty, (of(flown.map(_._2)), (again ++ copies).map(_ + ", and counts once")), unread)

  def of(recordings: Seq[Recording])(using Scenarios): FlightSet = FlightSet(recordings.map(FlightSummary.of))

  /** The files that were written.
    *
    * @param withoutPng why there are no PNG files, if so
    * @param isReplaced whether it replaced an older page
    * @param others recordings in the folder that it does not show
    * @param failures what is missing on the page, since a scenario's code threw
    */
  final case class Output(
      page: Path,
      withoutPng: Option[String],
      isReplaced: Boolean,
      others: Vector[String],
      failures: Vector[String]
  ):
    /** Right if the page is complete; Left lists what is missing, one line each. */
    def whole: Either[String, Unit] = Expect.that(failures.isEmpty)(failures.mkString("\n"))

    /** The page's path and remarks, in lines for the user. */
    def told: Vector[String] =
      val shown = if others.size <= MostNamed then others else others.take(MostNamed) :+ "…"
      s"Report: $page${if isReplaced then ", which replaces the one before" else ""}" +:
        Option.when(others.nonEmpty)(
          s"it does not show ${shown.mkString(", ")}, which are there too: " +
            s"./skein report ${Typed.recordings(page.resolveSibling(""))}"
        ).toVector

  private val MostNamed = 4

  /** Writes `report.html`, and each figure as `figures/NAME.svg` and `figures/NAME.png`, into a folder, which
    * is created if necessary; files of these names are replaced.
    *
    * @param files the flights' recordings; if empty, files with the flights' names
    * @return Left says why it could not be written
    */
  def write(set: FlightSet, directory: Path, files: Seq[Path] = Seq.empty)(using
      Scenarios
  ): Either[String, Output] =
    val figures  = ReportFigures.of(set)
    val sections = ReportSections.of(set, figures)
    val page     = directory.resolve("report.html")
    write(page, HtmlReport.render(set, sections), sections, figures.all, shown(set.all, files))

  /** Writes `spread.html` and its figures in the manner of `write`. */
  def writeSpread(flights: Seq[FlightSummary], directory: Path)(using Scenarios): Either[String, Output] =
    val figures  = ReportFigures.spread(flights)
    val sections = ReportSections.spread(flights, figures)
    write(
      directory.resolve("spread.html"),
      HtmlReport.spread(flights.size, sections),
      sections,
      figures.all,
      shown(flights, Seq.empty)
    )

  /** Whether a file in the page's folder is a recording of these flights. */
  private def shown(flights: Seq[FlightSummary], files: Seq[Path]): Path => Boolean =
    if files.nonEmpty then
      val read = files.map(real).toSet
      file => read(real(file))
    else
      val names = flights.map(flight => FlightPlan.fileName(flight.flight.id)).toSet
      file => names(file.getFileName.toString)

  private def real(file: Path): Path = Try(file.toRealPath()).getOrElse(file)

  private def write(
      page: Path,
      text: String,
      sections: Vector[Section],
      figures: Vector[Figure],
      isShown: Path => Boolean
  ): Either[String, Output] =
    FileReason.attempt(why => s"cannot write the report to $page: $why"):
      val isReplaced = Files.exists(page)
      val folder     = Files.createDirectories(page.resolveSibling("figures"))
      val _          = Files.writeString(page, text)
      for figure <- figures do
        Files.writeString(folder.resolve(s"${figure.name}.svg"), Svg.file(figure.drawing, figure.title))
      val (unpainted, painted) =
        onAllCores(figures)(figure => Png.bytes(figure.drawing).map(figure.name -> _)).partitionMap(identity)
      for (name, bytes) <- painted do Files.write(folder.resolve(s"$name.png"), bytes)
      Output(page, unpainted.headOption, isReplaced, others(page, isShown), sections.flatMap(_.failure))

  private def others(page: Path, isShown: Path => Boolean): Vector[String] =
    Using.resource(Files.list(page.toAbsolutePath.getParent)): files =>
      files.iterator.asScala
        .filter(_.getFileName.toString.endsWith(DuckDb))
        .filterNot(isShown)
        .map(_.getFileName.toString.stripSuffix(DuckDb))
        .toVector
        .sorted

  private val DuckDb = ".duckdb"

  private def onAllCores[A, B](items: Seq[A])(f: A => B): Vector[B] =
    InParallel.map(items, Runtime.getRuntime.availableProcessors)(f)
