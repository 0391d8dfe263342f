package skein.cli

import com.sun.management.UnixOperatingSystemMXBean
import java.lang.management.ManagementFactory
import skein.units.Expect

/** Checks the limit of open files and connections: a low limit looks like a simulator that does not answer.
  */
private[cli] object OpenFiles:
  /** Files that the program, each flight, and each further controller of a flight need. Measured: about 60
    * before the flights; 26 for a flight in real time with simulator and link; 450 for one with twenty
    * controllers.
    */
  private val OfTheProgram = 96
  private val OfAFlight    = 30
  private val OfAFurther   = 24

  /** @param controllers number of controllers of each flight
    * @param most maximum number of files that this process may open, if known
    */
  def enoughFor(flights: Int, controllers: Int = 1, most: Option[Long] = limit): Either[String, Unit] =
    val needed = OfTheProgram + (OfAFlight + OfAFurther * (controllers - 1)) * flights
    Expect.that(most.forall(_ >= needed)):
      s"expected room for $needed open files for $flights flights in real time, got ${most.getOrElse(0)}; " +
        s"ulimit -n $needed gives it"

  private def limit: Option[Long] = ManagementFactory.getOperatingSystemMXBean match
    case unix: UnixOperatingSystemMXBean => Some(unix.getMaxFileDescriptorCount)
    case _                               => None
