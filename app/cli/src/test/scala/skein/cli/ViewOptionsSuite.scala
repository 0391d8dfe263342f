package skein.cli

import mainargs.Flag

class ViewOptionsSuite extends munit.FunSuite:
  private def told(view: Boolean, port: Option[Int] = None, origins: String*) =
    ViewOptions(Flag(view), port, origins).mistake

  test("a port and sites without --view are refused, not ignored"):
    assertEquals(told(view = false), None)
    assertEquals(told(view = false, Some(9000)), Some("--view-port: expected with --view"))
    assertEquals(
      told(view = false, None, "https://app.foxglove.dev"),
      Some("--view-origin: expected with --view")
    )

  test("an invalid port, and a site that is not written as browsers write it, are refused"):
    for port <- Seq(0, 65535) do
      assertEquals(told(view = true, Some(port), "https://app.foxglove.dev", "http://localhost:8080"), None)
    for port <- Seq(-1, 65536) do
      assertEquals(told(view = true, Some(port)), Some(s"--view-port: expected 0 to 65535, got $port"))
    for site <- Seq("app.foxglove.dev", "https://app.foxglove.dev/", "", "*") do
      assert(
        told(view = true, None, "http://one", site).exists(_.endsWith(s"app.foxglove.dev, got '$site'")),
        site
      )
