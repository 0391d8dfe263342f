package skein.view

class AccessSuite extends munit.FunSuite:
  private val access = Access(8765)
  private val here   = "host" -> "127.0.0.1:8765"

  private val foreign = AccessSuite.foreign(8765)

  test("an origin that is not exactly the server's own is refused, also an invalid one"):
    for from <- foreign do assert(access.refusal(Seq(here, "origin" -> from)).isDefined, from)

  test("two origins are refused, even if both are the server's own"):
    val own = "origin" -> "http://127.0.0.1:8765"
    assertEquals(access.refusal(Seq(here, own)), None)
    assert(access.refusal(Seq(here, own, own)).isDefined)

  test(
    "programs, which send no origin, and the server's own pages are accepted by each name of this machine"
  ):
    for name <- Seq("127.0.0.1:8765", "localhost:8765", "[::1]:8765") do
      assertEquals(access.refusal(Seq("host" -> name)), None)
      assertEquals(access.refusal(Seq(here, "origin" -> s"http://$name")), None)

  test("a name that another site has directed to this machine is refused, as are a missing and a second one"):
    for name <- Seq(
        "elsewhere.example:8765",
        "127.0.0.1.elsewhere.example:8765",
        "elsewhere:8765",
        "127.0.0.1",
        "127.0.0.1:80",
        "127.0.0.1:8765:8765",
        "10.0.0.1:8765",
        ""
      )
    do assert(access.refusal(Seq("host" -> name)).isDefined, name)
    assert(access.refusal(Nil).isDefined)
    assert(access.refusal(Seq(here, here)).isDefined)

  test("a site that the user allows is accepted, and similar ones are refused"):
    val open = access.copy(origins = Set("https://app.foxglove.dev"))
    assertEquals(open.refusal(Seq(here, "origin" -> "https://app.foxglove.dev")), None)
    for from <- foreign ++ Seq("https://app.foxglove.dev.elsewhere.example", "https://app.foxglove.dev:443")
    do
      assert(open.refusal(Seq(here, "origin" -> from)).isDefined, from)

  test("on the web's own port, names without a port are accepted"):
    val web = Access(80)
    assertEquals(web.refusal(Seq("host" -> "localhost", "origin" -> "http://localhost")), None)
    assert(web.refusal(Seq("host" -> "elsewhere.example")).isDefined)

object AccessSuite:
  /** Headers by which a browser, or a program that imitates one, may name another site, or none. */
  def foreign(port: Int): Seq[String] = Seq(
    "http://elsewhere.example",
    "http://a{b.elsewhere.example",
    s"http://127.0.0.1:$port.elsewhere.example",
    s"http://127.0.0.1:$port@elsewhere.example",
    "http://elsewhere.example:99999",
    "http://elsewhere.example/",
    s"http://127.0.0.1:$port/",
    s"http://127.0.0.1:$port http://elsewhere.example",
    s"https://127.0.0.1:$port",
    s"http://127.0.0.1:${port}0",
    "http://127.0.0.1",
    s"http://127.0.0.1:${port + 1}",
    s"http://LOCALHOST:$port.",
    s"http://[::1]:$port.elsewhere.example",
    "http://[::1",
    "http://el sewhere.example",
    s"//127.0.0.1:$port",
    s"http://127.0.0.2:$port",
    s"http://:$port",
    "file://",
    "null",
    ""
  )
