package skein.record

import java.nio.file.{Files, Path}
import java.sql.Connection

/** Exports recordings for other programs. */
object Export:

  /** Writes each table as `TABLE.parquet` into the folder, which is created if necessary; files of these
    * names are replaced. Rows keep the order in which they were recorded. Blocks.
    *
    * @return the files written
    */
  def parquet(recording: Path, directory: Path): Either[RecordError, Vector[Path]] =
    def failed(reason: String): RecordError = RecordError.ExportFailed(recording, directory, reason)
    for
      _     <- FileReason.attempt(failed)(Files.createDirectories(directory))
      files <- RecordingReader.withRecording(recording): connection =>
        RecordingFile.attempt(failed):
          Table.all.filterNot(_.isMissing(connection)).map(table =>
            write(table, directory.resolve(table.name + ".parquet"), connection)
          )
    yield files

  private def write(table: Table[?], file: Path, connection: Connection): Path =
    val to = Sql.quoted(file.toString)
    Sql.execute(connection, s"COPY (SELECT * FROM ${table.name} ORDER BY row) TO $to (FORMAT parquet)")
    file
