package skein.record

import java.io.IOException
import java.nio.file.{AccessDeniedException, Files, Path}
import java.sql.Connection
import scala.util.Using
import skein.units.Expect

/** Reads recordings. A file left by a killed process is read like any other. */
object RecordingReader:

  /** Reads the whole recording into memory. Blocks. */
  def read(file: Path): Either[RecordError, Recording] =
    withRecording(file): connection =>
      RecordingFile
        .attempt(RecordError.NotARecording(file, _)):
          for flight <- Table.flight.read(connection).headOption
          yield Recording(
            RecordingHeader(flight, Table.vehicle.read(connection)),
            Table.ofRecording.flatMap(_.read(connection))
          )
        .flatMap(_.toRight(RecordError.NotARecording(file, "its table 'flight' is empty")))

  /** Every record with its row number, in that order. Blocks. */
  def records(file: Path): Either[RecordError, Vector[(Long, Record)]] =
    withRecording(file): connection =>
      RecordingFile.attempt(RecordError.NotARecording(file, _)):
        Table.all.flatMap(_.readNumbered(connection)).sortBy(_._1)

  /** Opens a file for reading only, checks that it is a recording of a supported format, and closes it
    * afterwards.
    */
  private[record] def withRecording[A](file: Path)(
      action: Connection => Either[RecordError, A]
  ): Either[RecordError, A] =
    if Files.isDirectory(file) then Left(RecordError.NotARecording(file, "it is a folder"))
    else if !Files.isRegularFile(file) then Left(RecordError.NoSuchFile(file))
    else
      for
        known  <- isDuckDb(file)
        _      <- Expect.that(known)(RecordError.NotARecording(file, "it is not a DuckDB file"))
        opened <- RecordingFile
          .attempt(RecordError.CannotOpen(file, _))(RecordingFile.connect(file, readOnly = true))
        result <- Using.resource(opened)(connection =>
          checkVersion(file, connection).flatMap(_ => action(connection))
        )
      yield result

  private def checkVersion(file: Path, connection: Connection): Either[RecordError, Unit] =
    RecordingFile
      .attempt(_ => RecordError.NotARecording(file, "it has no table 'format'"))(
        RecordingFormat.of(connection)
      )
      .flatMap: found =>
        Expect.that(found >= RecordingFormat.oldest && found <= RecordingFormat.version):
          RecordError.OtherVersion(file, RecordingFormat.oldest, RecordingFormat.version, found)

  /** Whether a file is a DuckDB file: its name follows an eight-byte checksum. */
  private def isDuckDb(file: Path): Either[RecordError, Boolean] =
    try
      Using.resource(Files.newInputStream(file)): in =>
        val start = in.readNBytes(12)
        Right(start.length == 12 && String(start, 8, 4, java.nio.charset.StandardCharsets.US_ASCII) == "DUCK")
    catch
      case _: AccessDeniedException => Left(RecordError.CannotOpen(file, "access denied"))
      case failed: IOException      => Left(RecordError.CannotOpen(file, s"${failed.getMessage}"))
