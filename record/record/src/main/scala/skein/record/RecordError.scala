package skein.record

import java.nio.file.Path

/** The reasons why a recording could not be written or read. */
enum RecordError(val message: String):

  /** There is a file at this path; recordings are never overwritten. */
  case AlreadyExists(file: Path)
      extends RecordError(s"$file exists already; recordings are never overwritten")

  /** The file could not be created, for example because the folder or permission is missing. */
  case CannotCreate(file: Path, reason: String) extends RecordError(s"cannot create recording $file: $reason")

  /** The database refused rows, for example because the disk is full. Rows committed before stay readable. */
  case WriteFailed(file: Path, reason: String)
      extends RecordError(s"cannot write to recording $file: $reason")

  /** More records waited than the queue holds: the disk is slower than the flight. */
  case QueueFull(capacity: Int)
      extends RecordError(s"recording cannot keep up: $capacity records wait to be written and no more fit")

  /** A recording in memory has as many records as it may: the flight is too long. */
  case MemoryFull(capacity: Int)
      extends RecordError(
        s"expected a shorter flight: a recording in memory has at most $capacity records, and it has as many"
      )

  case NoSuchFile(file: Path) extends RecordError(s"there is no file $file")

  /** The file is in use, for example by a flight that still writes to it, or may not be read. */
  case CannotOpen(file: Path, reason: String) extends RecordError(s"cannot open recording $file: $reason")

  /** The file is not a recording, or a damaged one. */
  case NotARecording(file: Path, reason: String) extends RecordError(s"$file is not a recording: $reason")

  /** The file is not a recording exported as MCAP, or a damaged one. */
  case NotAnExport(file: Path, reason: String)
      extends RecordError(s"$file is not an exported recording: $reason")

  /** The recording was written by a version with other tables. */
  case OtherVersion(file: Path, oldest: Int, newest: Int, found: Int)
      extends RecordError(
        s"$file has recording format $found; this program reads formats $oldest to $newest"
      )

  /** The recording could not be read to its end, or the folder or a file in it not be written. */
  case ExportFailed(recording: Path, to: Path, reason: String)
      extends RecordError(s"cannot export $recording to $to: $reason")
