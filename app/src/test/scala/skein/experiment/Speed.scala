package skein.experiment

import skein.loop.LoopKind
import skein.signal.LatencyProfile
import skein.units.*

/** Prints how many times faster than the clock a 60 s `stream` flight of two vehicles is flown on one thread, warm: run
  * it with `app/Test/runMain skein.experiment.measureSpeed 20`. The digests are the witnesses.
  */
@main def measureSpeed(flights: Int): Unit =
  val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(60),
    period = Span.ofMillis(100),
    seed = 5,
    pairs = 1,
    asPublished = false
  )
  val plan = settings.plans.head
  for flight <- 1 to flights do
    val cpu     = java.lang.management.ManagementFactory.getThreadMXBean
    val cpuAt   = cpu.getCurrentThreadCpuTime
    val began   = System.nanoTime()
    val flown   = VirtualFlights.fly(settings, plan).fold(sys.error(_), identity)
    val seconds = (System.nanoTime() - began) * 1e-9
    val busy    = (cpu.getCurrentThreadCpuTime - cpuAt) * 1e-9
    println(
      f"flight $flight%2d: $seconds%.3f s, ${60 / seconds}%.0f times real time; of the thread's own time ${60 / busy}%.0f times; ${flown.recorder.digest}"
    )
