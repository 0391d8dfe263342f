package skein.link

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.Source
import org.apache.pekko.util.ByteString
import scala.concurrent.Await
import scala.concurrent.duration.*

class FirstBytesSuite extends munit.FunSuite:
  import FirstBytes.*

  private given system: ActorSystem = ActorSystem("first-bytes")
  override def afterAll(): Unit     = Await.result(system.terminate(), 20.seconds): Unit

  private val requests =
    Seq(
      "GET / HTTP/1.1\r\n",
      "POST /x",
      "PUT /",
      "HEAD /",
      "DELETE /",
      "OPTIONS *",
      "CONNECT a:1",
      "TRACE /"
    ) ++
      Seq("PATCH /", "PRI * HTTP/2.0\r\n\r\n")
  private val hello = ByteString(22, 3, 1, 2, 0, 1)

  test("each HTTP request is foreign as soon as its method is complete, for any segmentation"):
    for request <- requests do
      val method = request.indexOf(' ') + 1
      for length <- 0 until method do
        assertEquals(verdict(ByteString(request.take(length))), Undecided, s"'${request.take(length)}'")
      for length <- method to request.length do
        assert(verdict(ByteString(request.take(length))).isInstanceOf[Foreign], request.take(length))

  test("a TLS record is refused at its first byte; 'GETTING', 'AKKA' and a four-byte length are not refused"):
    assertEquals(verdict(hello), Foreign("a greeting of TLS"))
    assertEquals(verdict(hello.take(1)), Foreign("a greeting of TLS"))
    for own <- Seq(ByteString("GETTING"), ByteString("AKKA"), ByteString(0, 0, 0, 10)) do
      assertEquals(verdict(own), Own)

  test("a port that knows its protocol's first bytes refuses all other bytes, even a single byte"):
    val own = Set(0xfd, 0xfe)
    assertEquals(verdict(ByteString(0xfd), own), Own)
    assertEquals(verdict(ByteString(0x00), own), Foreign("a first byte of 0x00"))
    assertEquals(verdict(ByteString("G"), own), Foreign("a first byte of 0x47"))
    assertEquals(verdict(ByteString("GET "), own), Foreign("an HTTP request (GET)"))
    assertEquals(verdict(hello, Set(22)), Own)

  /** All bytes that come through before the end, and how it ends. */
  private def through(pieces: Source[ByteString, Any]): (ByteString, Option[Throwable]) =
    var passed  = ByteString.empty
    val guarded = pieces.via(guard(Address("127.0.0.1", 5))).runForeach(passed ++= _)
    val end     = Await.ready(guarded, 20.seconds).value.get
    (passed, end.failed.toOption)

  private def through(pieces: String*): (ByteString, Option[Throwable]) =
    through(Source(pieces.map(ByteString(_))))

  test("the guard passes all bytes of its own protocol, and no bytes of other protocols"):
    assertEquals(through("G", "ET", "S on"), (ByteString("GETS on"), None))
    assertEquals(through("P", "UT"), (ByteString("PUT"), None), "which no more bytes follow")
    val (passed, error) = through("GE", "T / HTTP")
    assertEquals(
      (passed, error.map(_.getMessage)),
      (
        ByteString.empty,
        Some(
          "connection from 127.0.0.1:5 closed: expected this port's own protocol, got an HTTP request (GET)"
        )
      )
    )
    val lost  = TransportError.Lost(Address("127.0.0.1", 5), "reset")
    val reset = Source.single(ByteString("GE")).concat(Source.failed(lost))
    assertEquals(through(reset), (ByteString.empty, Some(lost)))
