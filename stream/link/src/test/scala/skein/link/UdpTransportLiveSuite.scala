package skein.link

import java.net.{DatagramPacket, DatagramSocket, InetAddress}
import java.util.concurrent.{LinkedBlockingQueue, TimeUnit}
import java.util.concurrent.atomic.AtomicInteger
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.testing.Unhurried
import skein.units.Span

class UdpTransportLiveSuite extends munit.FunSuite, Unhurried:

  test("a datagram that is larger than an Ethernet frame is received and sent whole"):
    given system: ActorSystem = ActorSystem("udp")
    val client                = DatagramSocket(0, InetAddress.getLoopbackAddress)
    client.setSoTimeout(10_000)
    try
      val echo = UdpTransport().listen(Address("127.0.0.1", 0)).to(
        Sink.foreach(_.flow.join(Flow[ByteString]).run(): Unit)
      ).run()
      val at = UdpSocket.resolved(Await.result(echo, 10.seconds).address)
      client.send(DatagramPacket(new Array[Byte](5_000), 5_000, at))
      val packet = DatagramPacket(new Array[Byte](10_000), 10_000)
      client.receive(packet)
      assertEquals(packet.getLength, 5_000)
    finally
      client.close()
      Await.result(system.terminate(), 10.seconds): Unit

  test("a peer that sends again after having been idle becomes one new connection and keeps it"):
    given system: ActorSystem = ActorSystem("udp")
    import system.dispatcher
    val idle   = Span.ofMillis(200)
    val server = UdpSocket.bind(Address("127.0.0.1", 0), mostPeers = 4, idle)
    val client = DatagramSocket(0, InetAddress.getLoopbackAddress)
    val heard  = LinkedBlockingQueue[(Int, String)]()
    val ended  = LinkedBlockingQueue[Int]()
    val count  = AtomicInteger()
    try
      server.onPeer: incoming =>
        val number = count.incrementAndGet()
        Source
          .maybe[ByteString]
          .via(incoming.flow)
          .toMat(Sink.foreach(bytes => heard.put((number, bytes.utf8String))))(Keep.right)
          .run()
          .onComplete(_ => ended.put(number))
      def says(text: String): (Int, String) =
        val bytes = text.getBytes
        client.send(DatagramPacket(bytes, bytes.length, UdpSocket.resolved(server.address)))
        heard.poll(10, TimeUnit.SECONDS)
      assertEquals(says("first"), (1, "first"))
      // Nothing else is a sign of idleness.
      Thread.sleep(idle.toMillis.toLong + 50)
      assertEquals(says("again"), (2, "again"))
      assertEquals(ended.poll(10, TimeUnit.SECONDS), 1)
      for text <- Seq("still", "here") do assertEquals(says(text), (2, text))
    finally
      client.close()
      server.close()
      Await.result(system.terminate(), 10.seconds): Unit
