package skein.record

/** Versions of a recording's tables. */
object RecordingFormat:

  /** Counts changes of the tables; a file of a later version is not read. */
  val version = 5

  /** Files since this version are read: what came later reads as absent. */
  val oldest = 2
