package skein.cli

import com.sun.management.UnixOperatingSystemMXBean
import java.lang.management.ManagementFactory
import skein.units.Expect

/** How many files and connections a process may have open: too few of them look like a simulator that does
  * not answer.
  */
private[cli] object OpenFiles:
  /** Measured: the program has some 60 open before it flies; a flight in real time, with simulator and link,
    * 26.
    */
  private val OfTheProgram = 96
  private val OfAFlight    = 30

  def enoughFor(flights: Int, most: Option[Long] = limit): Either[String, Unit] =
    val needed = OfTheProgram + OfAFlight * flights
    Expect.that(most.forall(_ >= needed)):
      s"expected room for $needed open files for $flights flights in real time, came ${most.getOrElse(0)}; " +
        s"ulimit -n $needed gives it"

  private def limit: Option[Long] = ManagementFactory.getOperatingSystemMXBean match
    case unix: UnixOperatingSystemMXBean => Some(unix.getMaxFileDescriptorCount)
    case _                               => None
