package skein.lanes.timetable

/** Makes the kinds of a [[Timetable]]'s operations visible outside this package. The constants of
  * [[TimetableKernel]] are package-private.
  */
private[lanes] object OperationKind:
  final val Look    = TimetableKernel.LOOK
  final val Decide  = TimetableKernel.DECIDE
  final val Act     = TimetableKernel.ACT
  final val Score   = TimetableKernel.SCORE
  final val Predict = TimetableKernel.PREDICT
