package skein.lanes.timetable

/** The operations of a [[Timetable]], for code outside this package, which cannot access the constants of
  * [[TimetableKernel]].
  */
private[lanes] object OperationKind:
  final val Look    = TimetableKernel.LOOK
  final val Decide  = TimetableKernel.DECIDE
  final val Act     = TimetableKernel.ACT
  final val Score   = TimetableKernel.SCORE
  final val Predict = TimetableKernel.PREDICT
