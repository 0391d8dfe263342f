package skein.cluster

import java.nio.file.Files
import java.security.KeyStore
import scala.util.Using
import skein.testing.TemporaryFolders

class TlsSuite extends munit.FunSuite, TemporaryFolders:
  folder.test("mistakes in a folder of certificates are described in words"): folder =>
    val store = KeyStore.getInstance("PKCS12")
    store.load(null, null)
    for name <- Seq(Tls.KeyStore, Tls.TrustStore) do
      Using.resource(Files.newOutputStream(folder.resolve(name)))(store.store(_, "secret".toCharArray))
    val password = Files.createDirectory(folder.resolve(Tls.Password))
    val refused  = Tls.of(folder).left.getOrElse("read")
    assert(clue(refused).startsWith(s"--tls: cannot read $password"))
    Files.delete(password)
    Files.writeString(password, "secret\n"): Unit
    val tls   = Tls.of(folder).fold(fail(_), identity)
    val whole = Files.readAllBytes(tls.keyStore)
    for length <- 0 until whole.length do
      Files.write(tls.keyStore, whole.take(length)): Unit
      val mistake = tls.context.left.getOrElse("read")
      assert(clue(mistake).startsWith("--tls: cannot read") && !mistake.endsWith("null"), length.toString)
