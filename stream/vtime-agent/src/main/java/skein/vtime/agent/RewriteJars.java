package skein.vtime.agent;

import java.io.IOException;
import java.net.MalformedURLException;
import java.net.URL;
import java.net.URLClassLoader;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import java.util.List;
import java.util.stream.Stream;
import java.util.zip.ZipEntry;
import java.util.zip.ZipInputStream;
import java.util.zip.ZipOutputStream;

/**
 * Rewrites the jars of a program once, in place, as {@link Agent} would at run time: such a program needs no
 * agent, which would prevent a JVM from using an ahead-of-time cache. That cache can hold its lambdas, too.
 */
public final class RewriteJars {
  private static final String AGENT = "skein/vtime/agent/Agent.class";
  private static final String DRAWS = "skein/vtime/agent/Draws.class";

  private RewriteJars() {}

  /**
   * Runs the rewriting.
   *
   * @param folder all jars of the program, including this one, which receives a class
   */
  public static void main(String... folder) throws IOException {
    List<Path> jars;
    try (Stream<Path> files = Files.list(Path.of(folder[0]))) {
      jars = files.filter(file -> file.toString().endsWith(".jar")).sorted().toList();
    }
    // Stack map frames are recomputed, which needs the class hierarchy.
    try (var classes = new URLClassLoader(jars.stream().map(RewriteJars::url).toArray(URL[]::new))) {
      var rewriter = new Rewriter(Rewriter.PACKAGES, RewriteJars::fail);
      for (var jar : jars) rewrite(jar, rewriter, classes);
    }
  }

  /** Rewrites a jar; one without any class to rewrite stays as it is. */
  private static void rewrite(Path jar, Rewriter rewriter, ClassLoader classes) throws IOException {
    var rewritten = jar.resolveSibling(jar.getFileName() + ".rewritten");
    var hasChanged = false;
    try (var in = new ZipInputStream(Files.newInputStream(jar));
        var out = new ZipOutputStream(Files.newOutputStream(rewritten))) {
      for (var entry = in.getNextEntry(); entry != null; entry = in.getNextEntry()) {
        var name = entry.getName();
        var before = in.readAllBytes();
        var after = name.endsWith(".class") ? rewrite(name, before, rewriter, classes) : before;
        hasChanged |= after != before || name.equals(AGENT);
        write(out, name, entry.getTime(), after);
        if (name.equals(AGENT)) write(out, DRAWS, entry.getTime(), Rewriter.DRAWS_CLASS);
      }
    }
    if (hasChanged) Files.move(rewritten, jar, StandardCopyOption.REPLACE_EXISTING);
    else Files.delete(rewritten);
  }

  private static byte[] rewrite(String name, byte[] bytes, Rewriter rewriter, ClassLoader classes) {
    var governed = rewriter.transform(classes, name.substring(0, name.length() - 6), null, null, bytes);
    var better = governed == null ? bytes : governed;
    var plain = PlainLambdas.rewrite(better);
    return plain == null ? better : plain;
  }

  private static void write(ZipOutputStream out, String name, long time, byte[] bytes) throws IOException {
    var entry = new ZipEntry(name);
    entry.setTime(time);
    out.putNextEntry(entry);
    out.write(bytes);
    out.closeEntry();
  }

  private static URL url(Path jar) {
    try {
      return jar.toUri().toURL();
    } catch (MalformedURLException impossible) {
      throw new AssertionError(impossible);
    }
  }

  private static void fail(String className, Throwable cause) {
    throw new IllegalStateException("cannot rewrite " + className, cause);
  }
}
