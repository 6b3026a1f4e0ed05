void main() {
  bad = 1;
}
