package skein.cli

import java.net.URI
import java.net.http.{HttpClient, HttpRequest, HttpResponse}
import mainargs.Flag
import scala.util.Using
import skein.cluster.Endpoint
import skein.testing.Unhurried

/** Over loopback. */
class MetricsServerLiveSuite extends munit.FunSuite, Unhurried:
  private val anyPort = Endpoint("127.0.0.1", 0)

  test("tells how it goes each time anew, to whoever asks for it and is no page of another site"):
    Using.resource(HttpClient.newHttpClient()): client =>
      var asked                                                        = 0
      var at                                                           = ""
      def get(path: String, headers: (String, String)*): (Int, String) =
        val request = HttpRequest.newBuilder(URI(at.replace("/metrics", path)))
        headers.foreach(request.header(_, _))
        val answer = client.send(request.build(), HttpResponse.BodyHandlers.ofString())
        (answer.statusCode, answer.body)
      def text() =
        asked += 1
        s"skein_asked $asked\n"
      val done = MetricsServer.serving(anyPort, text, line => at = line.stripPrefix("metrics at ")):
        assertEquals(get("/metrics"), (200, "skein_asked 1\n"))
        assertEquals(get("/metrics"), (200, "skein_asked 2\n"))
        assertEquals(get("/")._1, 404)
        assertEquals(get("/metrics", "Origin" -> "https://elsewhere.example")._1, 403)
        Right("done")
      assertEquals(done, Right("done"))

  test("a port that is taken is told, and nothing is done"):
    Using.resource(java.net.ServerSocket(0, 1, java.net.InetAddress.getByName("127.0.0.1"))): taken =>
      val listen = anyPort.copy(port = taken.getLocalPort)
      val told   = MetricsServer.serving(listen, () => "", _ => ())(fail("was done all the same"))
      assert(clue(told).left.exists(_.startsWith(s"--metrics: cannot listen at $listen")))

  test("a port stands for this machine's alone"):
    def checked(metrics: String) =
      ClusterOptions(Some(1), None, None, None, Flag(), Some(metrics)).checked.map(_.get.metrics)
    assertEquals(checked("9100"), Right(Some(Endpoint("127.0.0.1", 9100))))
    assertEquals(checked("0.0.0.0:9100"), Right(Some(Endpoint("0.0.0.0", 9100))))
    assert(clue(checked("x")).left.exists(_.contains("expected a port")))
    assert(ClusterOptions(None, None, None, None, Flag(), Some("9100")).checked.isLeft)
