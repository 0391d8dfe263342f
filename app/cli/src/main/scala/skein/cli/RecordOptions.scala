package skein.cli

import java.nio.file.{Files, Path}
import java.util.concurrent.ConcurrentLinkedQueue
import mainargs.{ParserForClass, arg}
import scala.jdk.CollectionConverters.*
import skein.record.{
  ClockKind,
  McapRecording,
  McapRowSink,
  PostgresRowSink,
  RecordError,
  RecordingHeader,
  RowSink
}
import skein.scene.Scene
import skein.settings.{FlightPlan, NamedScene}

/** Options for outputs of flights besides their DuckDB files. */
final case class RecordOptions(
    @arg(doc =
      "besides the DuckDB file: mcap writes a flight as an MCAP file, as export --mcap would; " +
        "postgres://HOST/DATABASE writes a live flight's tables there; can be repeated"
    )
    record: Seq[String]
):
  def checked(clock: ClockKind): Either[String, Unit] =
    val unknown = record
      .find(one => one != "mcap" && !isPostgres(one))
      .map(other =>
        "--record: expected mcap or " +
          s"postgres://USER:PASSWORD@HOST:PORT/DATABASE, got '${withoutSecrets(other)}'"
      )
    val untaken = Option.when(clock == ClockKind.Virtual && record.exists(isPostgres))(
      "--record: flights in virtual time are not written to Postgres; expected mcap"
    )
    unknown.orElse(untaken).toLeft(()).flatMap: _ =>
      if record.exists(isPostgres) then Extra.Postgres.checked.left.map("--record: " + _) else Right(())

  /** Removes what follows a colon, which may be a password. */
  private def withoutSecrets(one: String) =
    val scheme = one.takeWhile(_ != ':')
    if scheme == one then one else s"$scheme:…"

  private def isPostgres(one: String) = one.startsWith("postgres://") || one.startsWith("postgresql://")
  private def wantsMcap               = record.contains("mcap")

  private def sinksOf(
      plan: FlightPlan,
      folder: Path,
      heading: RecordingHeader,
      scene: Scene
  ): Seq[Either[String, RowSink]] =
    record.distinct.map:
      case "mcap" => McapRowSink.open(fileOf(plan, folder), heading, scene).left.map(_.message)
      case url    => PostgresRowSink.open(url, heading).left.map("--record: " + _)

  /** Left names an MCAP file of a flight that exists already. */
  def free(plans: Vector[FlightPlan], folder: Path): Either[String, Unit] =
    plans
      .filter(_ => wantsMcap)
      .map(fileOf(_, folder))
      .find(Files.exists(_))
      .map(RecordError.AlreadyExists(_).message)
      .toLeft(())

  private def fileOf(plan: FlightPlan, folder: Path) =
    val recording = plan.file(folder)
    recording.resolveSibling(recording.getFileName.toString.stripSuffix(".duckdb") + ".mcap")

  /** Exports the recording of a completed flight.
    *
    * @return Left says why it cannot be exported
    */
  def exported(plan: FlightPlan, folder: Path): Either[String, Unit] =
    if wantsMcap then
      McapRecording.write(plan.file(folder), fileOf(plan, folder), RecordOptions.sceneOf).left.map(_.message)
    else Right(())

object RecordOptions:
  given ParserForClass[RecordOptions] = ParserForClass[RecordOptions]

  /** The scene of a flight, from its recording's parameters; empty if these do not state it. */
  def sceneOf(parameters: Map[String, String]): Scene =
    NamedScene.ofRecording(parameters).fold(_ => Scene.Empty, _.scene)

  /** Outputs that are written while flights run, and their errors. */
  final class Sinks(options: RecordOptions, folder: Path, scene: Scene):
    private val opened = ConcurrentLinkedQueue[(flight: String, sink: RowSink)]()

    def open(plan: FlightPlan, heading: RecordingHeader): Either[String, Vector[RowSink]] =
      val (wrong, sinks) = options.sinksOf(plan, folder, heading, scene).partitionMap(identity)
      if wrong.isEmpty then
        sinks.foreach(sink => opened.add((plan.id, sink)))
        Right(sinks.toVector)
      else
        sinks.foreach: sink =>
          sink.close()
          sink.discard()
        Left(wrong.mkString("\n"))

    /** Removes outputs opened for flights that could not start. */
    def discard(flights: Seq[FlightPlan]): Unit =
      for one <- opened.asScala if flights.exists(_.id == one.flight) do
        one.sink.close()
        one.sink.discard()
        opened.remove(one): Unit

    def failures: Vector[String] = opened.asScala.flatMap(_.sink.failure).toVector
