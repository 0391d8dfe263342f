package skein.record

import io.zonky.test.db.postgres.embedded.EmbeddedPostgres
import java.sql.Connection
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.util.{Try, Using}
import skein.testing.{TemporaryFolders, Unhurried}

/** A real Postgres, in a process of its own. */
class PostgresRowSinkLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  private given system: ActorSystem = ActorSystem("PostgresRowSinkLiveSuite")

  private lazy val server: Try[EmbeddedPostgres] = Try(EmbeddedPostgres.builder().start())

  override def afterAll(): Unit =
    server.foreach(_.close())
    val _ = Await.result(system.terminate(), 10.seconds)

  private def url: String =
    server.failed.foreach(why => assume(false, s"no Postgres starts here: $why"))
    s"postgres://postgres:postgres@127.0.0.1:${server.get.getPort}/postgres"

  private def opened(heading: RecordingHeader) = PostgresRowSink.open(url, heading).fold(fail(_), identity)

  private def heading(id: String) = Samples.heading.copy(flight = Samples.heading.flight.copy(id = id))

  private def rowsOf(connection: Connection, table: Table[?], place: String): Vector[String] =
    val names = ("row" +: table.columns.definitions.map(_.name)).mkString(", ")
    Using.resource(connection.createStatement().executeQuery(s"SELECT $names FROM $place ORDER BY row")):
      found =>
        val width = found.getMetaData.getColumnCount
        Iterator
          .continually(found)
          .takeWhile(_.next())
          .map(row =>
            (1 to width).map(at =>
              row.getObject(at) match
                case list: java.sql.Array => list.getArray.asInstanceOf[Array[Object]].mkString("[", ",", "]")
                case _: (java.sql.Blob | Array[Byte]) => found.getBytes(at).mkString(" ")
                case other                            => s"$other"
            ).mkString("|")
          )
          .toVector

  folder.test("every table has the recording's own rows, value by value"): folder =>
    val file     = folder.resolve("flight.duckdb")
    val named    = heading("every-table")
    val sink     = opened(named)
    val recorder =
      Await.result(DuckDbRecorder.open(file, named, beside = Vector(sink)), 30.seconds).fold(
        error => fail(error.message),
        identity
      )
    for number <- 1L to 3000L do recorder.offer(Samples.reading(number))
    Samples.oneOfEach.foreach(recorder.offer)
    assert(Await.result(recorder.close(), 60.seconds).isRight)
    assertEquals(sink.failure, None)
    Using.resource(server.get.getPostgresDatabase.getConnection()): postgres =>
      val schemas = Using.resource(postgres.createStatement().executeQuery(
        "SELECT schema_name FROM information_schema.schemata WHERE schema_name LIKE 'every-table-%'"
      ))(found => Iterator.continually(found).takeWhile(_.next()).map(_.getString(1)).toVector)
      assertEquals(schemas.size, 1)
      Using.resource(RecordingFile.connect(file, readOnly = true)): duckDb =>
        for table <- Table.all do
          val own = rowsOf(duckDb, table, table.name)
          assert(own.nonEmpty, table.name)
          assertEquals(rowsOf(postgres, table, s"\"${schemas.head}\".${table.name}"), own, table.name)

  test("a blocked database delays nothing, and rows beyond the queue are counted and reported"):
    val named = heading("standing-still")
    val sink  = opened(named)
    Using.resource(server.get.getPostgresDatabase.getConnection()): other =>
      other.setAutoCommit(false)
      val schema = Using.resource(other.createStatement().executeQuery(
        "SELECT schema_name FROM information_schema.schemata WHERE schema_name LIKE 'standing-still-%'"
      ))(found => { found.next(): Unit; found.getString(1) })
      // No other connection can write to the table until this ends.
      other.createStatement().execute(s"LOCK TABLE \"$schema\".reading IN ACCESS EXCLUSIVE MODE"): Unit
      val rows = PostgresRowSink.Capacity + 10_000L
      val from = System.nanoTime()
      for number <- 1L to rows do sink.put(Seq((number, Samples.reading(number % 100))))
      val spentMs = (System.nanoTime() - from) / 1_000_000
      assert(spentMs < 5000, s"$spentMs ms")
      other.rollback()
    sink.close()
    val said = sink.failure.getOrElse(fail("nothing was lost"))
    assert("""(\d+) rows are missing""".r.findFirstMatchIn(said).exists(_.group(1).toInt >= 8000), said)

  test("rows that a lost connection did not take are counted, and not put down to the database's speed"):
    val sink = opened(heading("broken-off"))
    Using.resource(server.get.getPostgresDatabase.getConnection()): other =>
      other.createStatement().execute(
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE pid <> pg_backend_pid()"
      ): Unit
    for number <- 1L to 3000L do sink.put(Seq((number, Samples.reading(number))))
    sink.close()
    val said = sink.failure.getOrElse(fail("nothing was lost"))
    assert(clue(said).contains("; 3000 rows are missing from there on"))
    assert(!said.contains("slower"), said)

  test("the tables of a flight that could not start are deleted"):
    val sink = opened(heading("not-flown"))
    sink.close()
    sink.discard()
    assertEquals(sink.failure, None)
    Using.resource(server.get.getPostgresDatabase.getConnection()): postgres =>
      val found = postgres.createStatement().executeQuery(
        "SELECT count(*) FROM information_schema.schemata WHERE schema_name LIKE 'not-flown-%'"
      )
      found.next(): Unit
      assertEquals(found.getInt(1), 0)

  test("an IPv6 address is written in brackets"):
    def shown(host: String) = PostgresAddress.parse(s"postgres://me:secret@$host/flights").map(_.shown)
    assertEquals(shown("[::1]"), Right("[::1]:5432/flights"))
    assertEquals(shown("[::1]:7000"), Right("[::1]:7000/flights"))
    assert(shown("::1").isLeft)

  test("reserved characters in user and password are percent-encoded"):
    val read = PostgresAddress.parse("postgres://m%40e:a%3Ab%2Fc+%25@db/flights").fold(fail(_), identity)
    assertEquals((read.user, read.password, read.shown), ("m@e", "a:b/c+%", "db:5432/flights"))
    val wrong = PostgresAddress.parse("postgres://me:se%zzcret@db/flights").left.toOption.get
    assert(wrong.contains("two hexadecimal digits") && !wrong.contains("cret"), wrong)

  test("a missing server, or an invalid address, is reported in one line, without the password"):
    val nobody = PostgresRowSink.open("postgres://me:secret@127.0.0.1:1/db", Samples.heading)
    assert(
      nobody.left.exists(why => why.contains("127.0.0.1:1/db") && !why.contains("secret")),
      nobody.toString
    )
    for wrong <- Seq("postgres://db", "postgres://me:secret@127.0.0.1:99999/db") do
      assertEquals(
        PostgresRowSink.open(wrong, Samples.heading).left.toOption,
        Some("expected postgres://USER:PASSWORD@HOST:PORT/DATABASE")
      )
