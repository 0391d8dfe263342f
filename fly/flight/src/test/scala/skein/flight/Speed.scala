package skein.flight

import java.lang.management.ManagementFactory
import skein.loop.LoopKind
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*

/** Prints how many times faster than the clock a 60 s `stream` flight of two vehicles runs on one thread,
  * warm: run it with `flight/Test/runMain skein.flight.measureSpeed 40`. Under `taskset -c 0`, collections
  * and compilations share the one core. The last line covers the second half of the flights: by the clock,
  * and by the processor time of the whole process, which a busy machine disturbs less. The digests are the
  * witnesses.
  */
@main def measureSpeed(flights: Int): Unit =
  val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(60),
    period = Span.ofMillis(100),
    seed = 5
  )
  val plan  = settings.plans.head
  val times = (1 to flights).map: flight =>
    val cpuAt = processorNanos
    val began = System.nanoTime()
    val flown = VirtualFlights.fly(settings, plan).fold(sys.error(_), identity)
    val wall  = 60 / ((System.nanoTime() - began) * 1e-9)
    val cpu   = 60 / ((processorNanos - cpuAt) * 1e-9)
    println(
      f"flight $flight%3d: $wall%.0f times real time, $cpu%.0f " +
        f"times by processor time; ${flown.recorder.digest}"
    )
    (wall, cpu)
  val warm = times.drop(flights / 2)
  println(
    f"warm, median: ${median(warm.map(_._1))}%.0f times real time, " +
      f"${median(warm.map(_._2))}%.0f times by processor time"
  )

private def median(values: Seq[Double]): Double = values.sorted.apply(values.size / 2)

private def processorNanos: Long = ManagementFactory.getOperatingSystemMXBean match
  case system: com.sun.management.OperatingSystemMXBean => system.getProcessCpuTime
  case other                                            => sys.error(s"$other cannot tell")
