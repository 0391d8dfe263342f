package antenna

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import skein.units.*
import skein.vtime.VirtualTime

class AntennaSuite extends munit.FunSuite:

  private def tracked(seed: Long): Vector[(Double, Double, Double)] =
    var field: Option[Field] = None
    val _                    = VirtualTime.run(seed): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock = Clock.ofNanos(VirtualTime.clock(system))
      val world = Field(clock, seed)
      field = Some(world)
      system.scheduler.scheduleAtFixedRate(1.second, 1.second)(() => world.watch())
      Antenna.track(world.instruments, clock, Span.ofSeconds(40), _ => ())
    field.get.track

  test("after five seconds the antenna points within 6° of the balloon, lost answers or not"):
    for seed <- 1L to 10L do
      for (atS, bearing, azimuth) <- tracked(seed) if atS > 5 do
        assert(
          math.toDegrees((bearing - azimuth).abs) < 6,
          s"seed $seed at $atS s: $bearing and $azimuth rad"
        )

  test("equal seeds give equal flights"):
    assertEquals(tracked(7), tracked(7))

  test("it turns by the shorter way, and no faster than the motor can"):
    assertEqualsDouble(Antenna.rate(math.Pi - 0.1, -math.Pi + 0.1), -0.3, 1e-12)
    assertEquals(Antenna.rate(3, 0), 0.5)
