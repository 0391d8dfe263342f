package skein.cli

import skein.airsim.WorldSettings
import skein.link.Address

/** Chooses the listening address of `serve`. */
class ServeAddressSuite extends munit.FunSuite:
  private val world = WorldSettings.Default

  test("the default address is this machine's, at the settings' port, unless the command line sets another"):
    val set = world.copy(apiPort = Some(42099))
    assertEquals(ServeCommand.addressOf(None, world), Right(Address("127.0.0.1", 41451)))
    assertEquals(ServeCommand.addressOf(None, set), Right(Address("127.0.0.1", 42099)))
    assertEquals(ServeCommand.addressOf(Some("127.0.0.1:5000"), set), Right(Address("127.0.0.1", 5000)))
    assert(ServeCommand.addressOf(Some("nowhere"), set).left.exists(_.startsWith("--listen: ")))
