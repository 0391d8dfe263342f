package skein.airsim

import skein.link.Address
import skein.rpc.RpcError
import skein.units.Span

class AirSimErrorSuite extends munit.FunSuite:

  test("a silent peer is reported with its address, and what was expected there"):
    val at = Address("127.0.0.1", 9)
    assertEquals(
      AirSimError.ofFirst(RpcError.Timeout("ping", Span.ofSeconds(5)), at),
      "who listens at 127.0.0.1:9 takes the connection, but has said nothing for 5.0 s; " +
        "expected AirSim or ./skein serve there"
    )
    val nobody = RpcError.Unreachable(at, "nobody listens")
    assertEquals(AirSimError.ofFirst(nobody, at), nobody.message)
