package skein.rosbag

import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.record.MemoryRecorder
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.Span

private object Flown:
  /** The duel by `stream` over the VPN. */
  def stream(seconds: Double): MemoryRecorder =
    val settings = FlySettings(
      List(LoopKind.Stream),
      List(LatencyProfile.vpn),
      Span.ofSeconds(seconds),
      Span.ofMillis(100),
      seed = 3
    )
    VirtualFlights.fly(settings, settings.plans.last).fold(sys.error(_), _.recorder)
