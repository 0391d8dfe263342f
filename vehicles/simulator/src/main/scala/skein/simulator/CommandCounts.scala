package skein.simulator

/** Commands for which the simulator's clock waits: see [[SimulatorServer.start]].
  *
  * @param missed stops of the clock at which commands were awaited in vain
  * @param late commands that were left out, because one with a later stamp had arrived for their vehicle
  */
final case class CommandCounts(missed: Long, late: Long)

object CommandCounts:
  val Zero: CommandCounts = CommandCounts(0, 0)
