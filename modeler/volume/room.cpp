namespace sgm {}
