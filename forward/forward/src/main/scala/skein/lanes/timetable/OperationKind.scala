package skein.lanes.timetable

/** What an operation of a [[Timetable]] does, for those outside this package, to whom the numbers of
  * [[TimetableKernel]] are hidden.
  */
private[lanes] object OperationKind:
  final val Look    = TimetableKernel.LOOK
  final val Decide  = TimetableKernel.DECIDE
  final val Act     = TimetableKernel.ACT
  final val Score   = TimetableKernel.SCORE
  final val Predict = TimetableKernel.PREDICT
