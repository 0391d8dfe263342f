package skein.report

import java.io.IOException
import java.nio.file.{Files, Path}
import skein.figures.Figure
import skein.flight.InParallel
import skein.measure.{FlightSet, FlightSummary}
import skein.plot.{Png, Svg}
import skein.record.{RecordError, Recording, RecordingReader}
import skein.scenario.Scenarios

/** Turns recordings into tables and pictures; needs nothing but the recordings. */
object Report:

  /** Summarises recordings. All files are tried; every one that cannot be read is named. Blocks. */
  def read(files: Seq[Path])(using Scenarios): Either[Seq[RecordError], FlightSet] =
    val (unread, read) = onAllCores(files)(RecordingReader.read).partitionMap(identity)
    Either.cond(unread.isEmpty, of(read), unread)

  def of(recordings: Seq[Recording])(using Scenarios): FlightSet = FlightSet(recordings.map(FlightSummary.of))

  /** What was written.
    *
    * @param withoutPng why there are no PNG files, where there are none
    */
  final case class Output(page: Path, withoutPng: Option[String])

  /** Writes `report.html`, and each figure as `figures/NAME.svg` and `figures/NAME.png`, into a folder, which
    * is made if need be; files of these names are replaced.
    *
    * @return or why it could not be written
    */
  def write(set: FlightSet, directory: Path)(using Scenarios): Either[String, Output] =
    val figures = ReportFigures.of(set)
    write(directory.resolve("report.html"), HtmlReport.render(set, figures), figures)

  /** Writes `spread.html` and its figures likewise. */
  def writeSpread(flights: Seq[FlightSummary], directory: Path)(using Scenarios): Either[String, Output] =
    val figures = ReportFigures.spread(flights)
    write(directory.resolve("spread.html"), HtmlReport.spread(flights, figures), figures)

  private def write(page: Path, text: String, figures: Vector[Figure]): Either[String, Output] =
    try
      val folder = Files.createDirectories(page.resolveSibling("figures"))
      val _      = Files.writeString(page, text)
      for figure <- figures do
        Files.writeString(folder.resolve(s"${figure.name}.svg"), Svg.file(figure.drawing, figure.title))
      val (unpainted, painted) =
        onAllCores(figures)(figure => Png.bytes(figure.drawing).map(figure.name -> _)).partitionMap(identity)
      for (name, bytes) <- painted do Files.write(folder.resolve(s"$name.png"), bytes)
      Right(Output(page, unpainted.headOption))
    catch case failed: IOException => Left(s"cannot write the report to $page: $failed")

  /** What `f` makes of each, in their order. */
  private def onAllCores[A, B](items: Seq[A])(f: A => B): Vector[B] =
    InParallel.map(items, Runtime.getRuntime.availableProcessors)(f)
